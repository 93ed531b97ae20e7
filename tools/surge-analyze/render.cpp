// SPDX-License-Identifier: GPL-3.0-or-later
#include <unistd.h>

#include <cmath>
#include <cstdlib>

#include "analysis/picture.hpp"
#include "command.hpp"
#include "core/error.hpp"
#include "options.hpp"

namespace gdesp::tool {
namespace {

constexpr const char* nested = "GDESP_RENDER_UNDER_XVFB";

/// VTK draws through X. Without a display the program starts itself again under a virtual one; does not return then.
void require_display(const std::vector<std::string>& arguments) {
  if (std::getenv("DISPLAY") || std::getenv(nested)) return;
  ::setenv(nested, "1", 1);
  std::vector<std::string> words{"xvfb-run", "-a", "-s", "-screen 0 1280x1024x24", "/proc/self/exe", "render"};
  char self[4096];
  const ssize_t length = ::readlink("/proc/self/exe", self, sizeof self - 1);
  if (length > 0) words[4].assign(self, static_cast<std::size_t>(length));
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> raw;
  raw.reserve(words.size() + 1);
  for (std::string& w : words) raw.push_back(w.data());
  raw.push_back(nullptr);
  ::execvp(raw[0], raw.data());
  throw Error(ErrorKind::resource,
              "render draws through X, and there is neither a display (DISPLAY) nor xvfb-run "
              "(packages xvfb and xauth)");
}

std::string output_path(const CommandLine& line) {
  std::string path = line.has("output") ? line.get<std::string>("output")
                     : line.has("plot") ? line.get<std::string>("plot")
                                        : "";
  if (path.size() < 5 || path.substr(path.size() - 4) != ".png") {
    throw Error(ErrorKind::usage,
                "-o " + (path.empty() ? std::string("is missing") : path) + ": a name that ends in .png is needed");
  }
  return path;
}

// The frame nearest to the wanted time; without one, the frame in which the water is fastest on average.
Frame choose_frame(analysis::FrameSource& source, const CommandLine& line) {
  std::optional<Frame> best;
  double best_score = -1e300;
  while (auto frame = source.next([] { return cli::interrupted(); })) {
    double score = 0.0;
    if (line.has("time")) {
      score = -std::abs(frame->time - line.get<double>("time"));
    } else {
      for (const Vec3f& v : frame->fluid.velocity) score += dot(v, v);
    }
    if (score > best_score || !best)
      best_score = score, best = std::move(*frame);
    else if (line.has("time"))
      break;  // times only grow
  }
  return std::move(*best);
}

}  // namespace

int run_render(const std::vector<std::string>& arguments) {
  po::options_description own("Picture");
  own.add_options()("output,o", po::value<std::string>()->value_name("FILE.png"), "the picture (--plot does the same)");
  own.add_options()("time,t", po::value<double>()->value_name("S"),
                    "the nearest frame (default: when the water has most kinetic energy)");
  own.add_options()("size", po::value<std::string>()->value_name("W,H")->default_value("1600,900"), "pixels");
  own.add_options()("azimuth", po::value<double>()->value_name("DEG"),
                    "where the camera stands, clockwise from +y (default: facing the slide)");
  own.add_options()("elevation", po::value<double>()->value_name("DEG")->default_value(44.0, "44"),
                    "of the camera above the horizontal");
  own.add_options()("zoom", po::value<double>()->value_name("F")->default_value(1.0, "1"), "above 1: closer");
  own.add_options()("speed-max", po::value<double>()->value_name("M/S")->default_value(0.0, "chosen"),
                    "end of the colour scale");
  own.add_options()("exaggeration", po::value<double>()->value_name("F")->default_value(1.0, "1"), "of heights");
  own.add_options()("title", po::value<std::string>()->value_name("TEXT")->default_value(""), "default: the scene's");
  CommandLine line("render", own);
  const char* definition =
      "One picture in three dimensions: terrain shaded, with contour lines and the still-water shore; the water's "
      "surface\n"
      "(see surface --help) coloured by speed; grains and bodies in orange. Without a display the program runs itself\n"
      "under xvfb-run.\n";
  if (!line.parse(arguments, definition, "surge-analyze render lake.run -o lake.png --time 25 --azimuth 210")) return 0;
  const std::string path = output_path(line);
  const std::vector<double> size = parse_numbers("--size", line.get<std::string>("size"));
  if (size.size() != 2 || size[0] < 100 || size[1] < 100 || size[0] > 8000 || size[1] > 8000) {
    throw Error(ErrorKind::usage, "--size: two numbers between 100 and 8000 are needed");
  }
  if (!line.get<std::vector<std::string>>("input").empty() && line.get<std::vector<std::string>>("input")[0] == "-") {
    throw Error(ErrorKind::usage, "render: a run folder or frame files are needed, not records");
  }
  require_display(arguments);
  cli::install_signal_handlers();
  analysis::FrameSource source(source_options(line));
  const Frame frame = choose_frame(source, line);
  analysis::PictureOptions options;
  options.width = static_cast<int>(size[0]);
  options.height = static_cast<int>(size[1]);
  if (line.has("azimuth")) options.azimuth = line.get<double>("azimuth");
  options.elevation = line.get<double>("elevation");
  options.zoom = line.get<double>("zoom");
  options.speed_max = line.get<double>("speed-max");
  options.vertical_exaggeration = line.get<double>("exaggeration");
  options.title = line.get<std::string>("title");
  analysis::draw_picture(frame, source.info(), options, path);
  cli::info("picture: " + path + " (t = " + analysis::format_number(frame.time) + " s)");
  return 0;
}

}  // namespace gdesp::tool
