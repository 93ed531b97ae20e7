// SPDX-License-Identifier: GPL-3.0-or-later
#include "seeds.hpp"

#include <gdal_priv.h>
#include <openvdb/openvdb.h>
#include <openvdb/points/PointAttribute.h>
#include <openvdb/points/PointConversion.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "checkpoint_files.hpp"
#include "geometry/case_builder.hpp"
#include "geometry/triangle_mesh.hpp"
#include "io/case.hpp"
#include "io/frame.hpp"
#include "recovery.hpp"
#include "support/tank.hpp"
#include "support/temp_folder.hpp"

namespace gdesp::fuzz {
namespace {

namespace fs = std::filesystem;

Seeds files_of(const fs::path& folder) {
  Seeds out;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file())
      out.push_back({entry.path().filename().string(), test::text_of_file(entry.path().string())});
  }
  return out;
}

std::string geotiff(const std::string& path, const char* compression) {
  GDALAllRegister();
  const char* const options[] = {compression, nullptr};
  float z[48];
  for (int k = 0; k < 48; ++k) z[k] = 100.0f + static_cast<float>(k % 7);
  double where[6] = {500000.0, 10.0, 0.0, 5100000.0, 0.0, -10.0};
  GDALDataset* data = GetGDALDriverManager()->GetDriverByName("GTiff")->Create(path.c_str(), 8, 6, 1, GDT_Float32,
                                                                               const_cast<char**>(options));
  data->SetGeoTransform(where);
  if (data->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, 8, 6, z, 8, 6, GDT_Float32, 0, 0) != CE_None)
    std::perror(path.c_str());
  GDALClose(data);
  return test::text_of_file(path);
}

template <class T>
void put(std::string& out, const T& value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string binary_stl(const geometry::TriangleMesh& mesh) {
  std::string out(80, ' ');
  put(out, static_cast<std::uint32_t>(mesh.triangle.size()));
  for (const auto& t : mesh.triangle) {
    put(out, Vec3f{});
    for (int c = 0; c < 3; ++c) put(out, static_cast<Vec3f>(mesh.vertex[t[c]]));
    put(out, std::uint16_t{0});
  }
  return out;
}

std::string binary_ply(const geometry::TriangleMesh& mesh) {
  std::string out = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(mesh.vertex.size()) +
                    "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
                    std::to_string(mesh.triangle.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const auto& v : mesh.vertex) put(out, v);
  for (const auto& t : mesh.triangle) put(out, std::uint8_t{3}), put(out, t);
  return out;
}

std::string vdb_points(const std::string& path) {
  openvdb::initialize();
  std::vector<openvdb::Vec3f> place, velocity;
  for (int i = 0; i < 12; ++i)
    place.emplace_back(0.3f * float(i), 1.0f, 0.0f), velocity.emplace_back(float(i), 0.0f, 1.0f);
  namespace points = openvdb::points;
  const auto transform = openvdb::math::Transform::createLinearTransform(0.5);
  const points::PointAttributeVector<openvdb::Vec3f> wrapped(place);
  const auto index = openvdb::tools::createPointIndexGrid<openvdb::tools::PointIndexGrid>(wrapped, *transform);
  auto grid = points::createPointDataGrid<points::NullCodec, points::PointDataGrid>(*index, wrapped, *transform);
  points::appendAttribute<openvdb::Vec3f>(grid->tree(), "velocity");
  points::populateAttribute(grid->tree(), index->tree(), "velocity",
                            points::PointAttributeVector<openvdb::Vec3f>(velocity));
  grid->setName("particles");
  openvdb::io::File(path).write({grid});
  return test::text_of_file(path);
}

Frame small_frame() {
  Frame frame;
  frame.time = 0.5;
  for (int k = 0; k < 5; ++k) {
    frame.fluid.position.push_back({0.1 * k, 0.0, 0.2});
    frame.fluid.velocity.push_back({0.0f, 1.0f, 0.1f * float(k)});
    frame.fluid.density.push_back(1000.0f);
    frame.fluid.pressure.push_back(10.0f);
    frame.fluid.id.push_back(static_cast<std::uint32_t>(k));
  }
  frame.grains.position = {{0.0, 0.0, 1.0}, {0.2, 0.0, 1.0}};
  frame.grains.diameter = {0.1f, 0.1f};
  frame.grains.density = {2650.0f, 2650.0f};
  frame.grains.velocity = {{}, {}};
  frame.grains.group = {0, 0};
  const geometry::TriangleMesh box = geometry::box_mesh({{0, 0, 0}, {1, 1, 1}});
  frame.bodies.vertex = box.vertex;
  frame.bodies.triangle = box.triangle;
  frame.bodies.body.assign(box.triangle.size(), 1);
  frame.body_states.resize(1);
  return frame;
}

FramePaths write_frame(const std::string& folder) {
  FrameWriter writer(folder + "/frames.run", {1000.0, 0.0, 0.0}, 0.1, true, false);
  return writer.write(small_frame());
}

}  // namespace

Seeds raster_seeds(const std::string& folder) {
  return {{"b.tif", geotiff(folder + "/plain.tif", "COMPRESS=NONE")},
          {"c.tif", geotiff(folder + "/packed.tif", "COMPRESS=DEFLATE")}};
}

Seeds mesh_seeds(const std::string&) {
  const geometry::TriangleMesh box = geometry::box_mesh({{0, 0, 0}, {1, 2, 3}});
  return {{"b.stl", binary_stl(box)}, {"b.ply", binary_ply(box)}};
}

Seeds frame_seeds(const std::string& folder) {
  const FramePaths paths = write_frame(folder);
  return {{"fluid.vtp", test::text_of_file(paths.fluid)},
          {"grains.vtp", test::text_of_file(paths.grains)},
          {"points.vdb", vdb_points(folder + "/points.vdb")}};
}

Seeds triangle_seeds(const std::string& folder) {
  return {{"bodies.vtp", test::text_of_file(write_frame(folder).bodies)}};
}

Seeds case_seeds(const std::string& folder) {
  std::ofstream(folder + "/scene.toml") << small_scene();
  geometry::BuildReport report;
  write_case(folder + "/good.case", geometry::build_case(read_scene(folder + "/scene.toml", {}), report), true);
  return files_of(folder + "/good.case");
}

Seeds record_seeds(const std::string& folder) {
  case_seeds(folder);
  FrameWriter writer(folder + "/a.run", {1000.0, 0.0, 0.0}, 0.1, true, false);
  std::string water, grains,
      last =
          "{\"record\":\"done\",\"run\":\"a.run\",\"case\":\"good.case\",\"steps\":40,\"t\":1.5,\"particles\":7,"
          "\"device\":\"cpu\"}\n";
  for (int k = 0; k < 2; ++k) {
    Frame frame = small_frame();
    frame.time += k;
    const FramePaths paths = writer.write(frame);
    const auto name = [&](const std::string& path) { return '"' + fs::relative(path, folder).string() + '"'; };
    const std::string end =
        ",\"t\":" + std::to_string(frame.time) + ",\"step\":" + std::to_string(20 * (k + 1)) + "}\n";
    water += "{\"record\":\"frame\",\"path\":" + name(paths.fluid) + ",\"fluid\":" + name(paths.fluid) +
             ",\"grains\":" + name(paths.grains) + ",\"bodies\":" + name(paths.bodies) + ",\"case\":\"good.case\"" +
             end;
    grains += "{\"record\":\"frame\",\"path\":" + name(paths.grains) + ",\"grains\":" + name(paths.grains) +
              ",\"case\":\"good.case\"" + end;
  }
  return {{"water.ndjson", "{\"record\":\"case\",\"path\":\"good.case\"}\n" + water + last},
          {"grains.ndjson", grains + last},
          {"short.ndjson", grains}};
}

SimulationInput small_tank() {
  SimulationInput input = test::tank_input({1.0, 0.0, 1.0}, 0.4, 0.2, 2);
  test::fill_block(input.fluid, {}, {1.0, 0.0, 0.4}, 0.2, true);
  return input;
}

Seeds checkpoint_seeds(const std::string& folder) {
  const std::unique_ptr<Simulation> simulation = make_simulation(small_tank(), "cpu");
  for (int k = 0; k < 3; ++k) simulation->step(1.0);
  const tool::Checkpoint c = tool::CheckpointFiles(folder + "/seed.run", checkpoint_fingerprint)
                                 .write(*simulation, {}, tool::Recovery(0.0), 1.0);
  return {{"a.state", test::text_of_file(c.path)}};
}

std::string with_sound_trailer(std::string bytes) {
  struct Trailer {
    std::uint64_t size, checksum;
    char mark[8];
  };
  if (bytes.size() < sizeof(Trailer)) return bytes;
  bytes.resize(bytes.size() - sizeof(Trailer));
  tool::Checksum checksum;
  checksum.add(bytes.data(), bytes.size());
  Trailer trailer{bytes.size(), checksum.value(), {}};
  std::memcpy(trailer.mark, bytes.data(),
              std::min(bytes.size(), sizeof trailer.mark));  // the file begins with the same mark
  put(bytes, trailer);
  return bytes;
}

std::string small_scene() {
  return "[resolution]\ndp = 0.1\n[[wall]]\ntank = {lower = [0, 0, 0], upper = [0.6, 0.3, 0.4]}\nopen = [\"top\"]\n"
         "[[fluid.fill]]\nbox = {lower = [0, 0, 0], upper = [0.6, 0.3, 0.2]}\n"
         "[[slide]]\nbox = {lower = [0.1, 0, 0.2], upper = [0.4, 0.3, 0.4]}\ndiameter = 0.1\n"
         "[[gate]]\nbox = {lower = [0.5, 0, 0.2], upper = [0.6, 0.3, 0.4]}\nvelocity = [0, 0, 1]\n[[gauge]]\nat = "
         "[0.3, 0.1]\n";
}

}  // namespace gdesp::fuzz
