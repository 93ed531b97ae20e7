// SPDX-License-Identifier: GPL-3.0-or-later
// Files cut short or changed at any place end in an Error, never in a crash, a hang or a memory blow-up.
#include <random>

#include "io/point_source.hpp"
#include "io/tables.hpp"
#include "io_fixture.hpp"

namespace gdesp::test {
namespace {

class TornFiles : public ::testing::Test {
 protected:
  TempFolder folder;

  std::string fluid_text() {
    const double time = 1.5;
    write_fluid(folder / "f.vtp", some_fluid(30), {{"time", ScalarType::float64, 1, &time, 1}});
    return text_of_file(folder / "f.vtp");
  }
  /// True when the text was read, false when it was refused as input; anything else is a failure.
  bool reads(const std::string& text) {
    try {
      read_fluid_frame(folder.write("t.vtp", text), {}, nullptr);
      return true;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
      EXPECT_NE(std::string(error.what()).find("t.vtp"), std::string::npos) << error.what();
      return false;
    }
  }
  std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  }
};

TEST_F(TornFiles, cut_anywhere) {
  const std::string text = fluid_text();
  ASSERT_TRUE(reads(text));
  for (std::size_t length = 0; length < text.size() - 12; length += 23)
    EXPECT_FALSE(reads(text.substr(0, length))) << length;
}

TEST_F(TornFiles, own_files_never_reach_vtk_for_being_torn) {
  const std::string text = fluid_text();
  EXPECT_THROW(open_plain_vtp(folder.write("t.vtp", text.substr(0, text.size() / 2))), Error);
}

TEST_F(TornFiles, sizes_that_lie) {
  const std::string text = fluid_text();
  EXPECT_FALSE(reads(replaced(text, "NumberOfPoints=\"30\"", "NumberOfPoints=\"31\"")));
  EXPECT_FALSE(reads(replaced(text, "NumberOfPoints=\"30\"", "NumberOfPoints=\"29\"")));
  EXPECT_FALSE(reads(replaced(text, "NumberOfPoints=\"30\"", "NumberOfPoints=\"999999999999999\"")));
  EXPECT_FALSE(reads(replaced(text, "NumberOfPoints=\"30\"", "NumberOfPoints=\"-1\"")));
  EXPECT_FALSE(reads(replaced(text, "NumberOfPoints=\"30\"", "NumberOfPoints=\"99999999999999999999999\"")));
  EXPECT_FALSE(reads(replaced(text, "NumberOfComponents=\"3\"", "NumberOfComponents=\"0\"")));
  EXPECT_FALSE(reads(replaced(text, "NumberOfComponents=\"3\"", "NumberOfComponents=\"999999\"")));
  EXPECT_FALSE(reads(replaced(text, "Float64\" Name=\"Points", "Float32\" Name=\"Points")));
  const std::size_t stream = text.find("binary\">\n", text.find("\"velocity\"")) + 9;
  EXPECT_FALSE(reads(std::string(text).replace(stream, 11, "/////////x8"))) << "an array's own byte count";
  EXPECT_FALSE(reads(std::string(text).replace(stream, 4, "AAAA"))) << "an array's own byte count";
}

TEST_F(TornFiles, garbage) {
  EXPECT_FALSE(reads(""));
  EXPECT_FALSE(reads("hello"));
  EXPECT_FALSE(reads("<"));
  EXPECT_FALSE(reads("<VTKFile"));
  EXPECT_FALSE(reads("<VTKFile type=\"PolyData\">"));
  EXPECT_FALSE(reads("<VTKFile type=\"PolyData\" byte_order=\"LittleEndian\"></VTKFile>"));
  EXPECT_FALSE(reads(std::string(10000, '<')));
  EXPECT_FALSE(reads(std::string(10000, '\0')));
}

/// Single bytes changed at random: the file is refused or read, and what is read has the right sizes.
TEST_F(TornFiles, changed_bytes_do_no_harm) {
  const std::string text = fluid_text();
  std::mt19937 engine(11);
  int refused = 0;
  for (int i = 0; i < 300; ++i) {
    std::string changed = text;
    for (int k = 0; k < 1 + i % 3; ++k) changed[engine() % changed.size()] = char(engine());
    try {
      const std::unique_ptr<PointSource> source = open_plain_vtp(folder.write("t.vtp", changed));
      if (source) fluid_of(*source, "t.vtp", {});
    } catch (const Error&) { ++refused; }
  }
  EXPECT_GT(refused, 25);
}

TEST_F(TornFiles, triangles_that_name_no_vertex) {
  TriangleTable t = some_triangles();
  t.triangle[2].z = -1;
  write_triangles(folder / "t.vtp", t, {});
  expect_error(ErrorKind::input, {"t.vtp", "vertex -1"}, [&] { read_triangles_vtp(folder / "t.vtp"); });
}

TEST_F(TornFiles, case_toml_cut_anywhere) {
  Case c;
  c.scene = read_scene(folder.write("s.toml", "[resolution]\ndp = 1\n"), {});
  c.domain = {{0, 0, 0}, {1, 1, 1}};
  c.fluid = some_fluid(3);
  c.sources = {{"/data/valley.tif", std::string(64, 'a')}};
  write_case(folder / "c.case", c, false);
  const std::string text = text_of_file(folder / "c.case/case.toml");
  const std::size_t counts = text.find("counts = ");
  ASSERT_NE(counts, std::string::npos);
  for (std::size_t length = 0; length < counts + 9; length += 5) {
    folder.write("c.case/case.toml", text.substr(0, length));
    expect_error(ErrorKind::input, {"case.toml"}, [&] { read_case(folder / "c.case"); });
  }
}

}  // namespace
}  // namespace gdesp::test
