// SPDX-License-Identifier: GPL-3.0-or-later
// Particles in OpenVDB points files.
#include <openvdb/openvdb.h>
#include <openvdb/points/PointAttribute.h>
#include <openvdb/points/PointConversion.h>

#include <map>

#include "io_fixture.hpp"

namespace gdesp::test {
namespace {

namespace points = openvdb::points;

/// 100 points with velocity and density, whose values follow from the place.
std::string write_points(const TempFolder& folder) {
  openvdb::initialize();
  std::vector<openvdb::Vec3f> place, velocity;
  std::vector<float> density;
  for (int i = 0; i < 100; ++i) {
    place.emplace_back(0.25f * float(i), 1.0f, -2.0f);
    velocity.emplace_back(float(i), 0.0f, 1.0f);
    density.push_back(1000.0f + float(i));
  }
  const auto transform = openvdb::math::Transform::createLinearTransform(0.5);
  const points::PointAttributeVector<openvdb::Vec3f> wrapped(place);
  const auto index = openvdb::tools::createPointIndexGrid<openvdb::tools::PointIndexGrid>(wrapped, *transform);
  auto grid = points::createPointDataGrid<points::NullCodec, points::PointDataGrid>(*index, wrapped, *transform);
  points::appendAttribute<openvdb::Vec3f>(grid->tree(), "v");
  points::appendAttribute<float>(grid->tree(), "density");
  points::populateAttribute(grid->tree(), index->tree(), "v", points::PointAttributeVector<openvdb::Vec3f>(velocity));
  points::populateAttribute(grid->tree(), index->tree(), "density", points::PointAttributeVector<float>(density));
  grid->insertMeta("time", openvdb::FloatMetadata(1.5f));
  grid->setName("particles");
  openvdb::io::File(folder / "p.vdb").write({grid});
  return folder / "p.vdb";
}

TEST(ForeignVdb, points_with_their_attributes) {
  const TempFolder folder;
  FrameMeta meta;
  const FluidTable f = read_fluid_frame(write_points(folder), {{"velocity", "v"}}, &meta);
  ASSERT_EQ(f.position.size(), 100u);
  ASSERT_EQ(f.density.size(), 100u);
  std::map<int, bool> seen;
  for (std::size_t i = 0; i < 100; ++i) {
    const int number = int(f.density[i]) - 1000;
    seen[number] = true;
    EXPECT_NEAR(f.position[i].x, 0.25 * number, 1e-6);
    EXPECT_NEAR(f.position[i].z, -2.0, 1e-6);
    EXPECT_EQ(f.velocity[i].x, float(number));
  }
  EXPECT_EQ(seen.size(), 100u);
  EXPECT_TRUE(meta.has_time);
  EXPECT_EQ(meta.time, 1.5);
}

TEST(ForeignVdb, file_that_holds_no_points) {
  const TempFolder folder;
  openvdb::initialize();
  openvdb::io::File(folder / "g.vdb").write({openvdb::FloatGrid::create(1.0f)});
  expect_error(ErrorKind::input, {"g.vdb", "no point grid"}, [&] { read_fluid_frame(folder / "g.vdb", {}, nullptr); });
  expect_error(ErrorKind::input, {"n.vdb", "no such file"}, [&] { read_fluid_frame(folder / "n.vdb", {}, nullptr); });
  expect_error(ErrorKind::input, {"x.vdb"}, [&] { read_fluid_frame(folder.write("x.vdb", "hello"), {}, nullptr); });
}

TEST(ForeignVdb, torn_file) {
  const TempFolder folder;
  const std::string text = text_of_file(write_points(folder));
  for (int i = 0; i < 16; ++i) {
    const std::string torn = folder.write("t.vdb", text.substr(0, text.size() * std::size_t(i) / 17));
    expect_error(ErrorKind::input, {"t.vdb"}, [&] { read_fluid_frame(torn, {}, nullptr); });
  }
}

TEST(ForeignVdb, changed_bytes_do_no_harm) {
  const TempFolder folder;
  expect_changed_bytes_do_no_harm(folder, write_points(folder), 40);
}

}  // namespace
}  // namespace gdesp::test
