// SPDX-License-Identifier: GPL-3.0-or-later
// Writing a frame of water as gdesp-run does, into a temporary folder.
// usage: bench_write_frame [sizes] [threads]
#include <unistd.h>

#include <filesystem>

#include "bench.hpp"
#include "io/frame.hpp"

namespace {

void run(long particles, int threads) {
  using namespace gdesp;
  namespace fs = std::filesystem;
  Frame frame;
  bench::Random random;
  for (long k = 0; k < particles; ++k) {
    const auto u = [&] { return static_cast<float>(random()); };
    frame.fluid.position.push_back({random(), random(), random()});
    frame.fluid.velocity.push_back({u(), u(), u()});
    frame.fluid.density.push_back(1000.0f + u());
    frame.fluid.pressure.push_back(1.0e4f * u());
    frame.fluid.porosity.push_back(1.0f);
    frame.fluid.mass_share.push_back(1.0f);
    frame.fluid.id.push_back(static_cast<std::uint32_t>(k));
  }
  const fs::path folder = fs::temp_directory_path() / ("gdesp-bench-" + std::to_string(::getpid()));
  double bytes = 0.0;
  {
    FrameWriter writer(folder.string(), {}, 0.01, true, false);
    const double seconds = bench::best_seconds(3, [&] {
      const FramePaths paths = writer.write(frame);
      bytes =
          static_cast<double>(fs::file_size(fs::exists(paths.fluid) ? fs::path(paths.fluid) : folder / paths.fluid));
      frame.time += 1.0;
    });
    bench::print({"write_frame", particles, threads}, static_cast<double>(particles) / seconds, "particles/s",
                 {{"bytes_per_particle", bytes / static_cast<double>(particles)}});
  }
  fs::remove_all(folder);
}

}  // namespace

int main(int argc, char** argv) { return gdesp::bench::for_each_case(argc, argv, "100000", run); }
