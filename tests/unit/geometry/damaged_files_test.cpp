// SPDX-License-Identifier: GPL-3.0-or-later
// Cut and scrambled files of every format: an error that names the file, or a mesh with sane indices. Never a crash.
#include "geometry/file_check.hpp"
#include "geometry/mesh_reader.hpp"
#include "geometry/random.hpp"
#include "support.hpp"

namespace gdesp::geometry {
namespace {

using testing::Folder;

const char* const samples[][2] = {
    {"a.off", "OFF\n4 4 0\n0 0 0\n3 0 0\n0 3 0\n0 0 3\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"},
    {"a.obj", "v 0 0 0\nv 3 0 0\nv 0 3 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"},
    {"a.stl",
     "solid s\nfacet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  vertex 0 1 0\n "
     "endloop\nendfacet\nendsolid s\n"},
    {"a.ply",
     "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\nelement face "
     "1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
    {"a.vtk",
     "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 4 double\n0 0 0 3 0 0 0 3 0 0 0 3\nPOLYGONS 4 "
     "16\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"},
    {"a.asc", "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n1 2 3\n4 5 6\n"},
    {"a.xyz", "0 0 1\n1 0 2\n0 1 3\n1 1 4\n"},
};

void judge(const Folder& folder, const std::string& name, const std::string& text) {
  const std::string path = folder.write(name, text);
  const FileReport r = check_file(path);  // does not throw
  if (r.verdict == MeshVerdict::refused) { EXPECT_FALSE(r.refusal.empty()) << name; }
  std::filesystem::remove(path);
}

TEST(DamagedFiles, CutAtEveryLength) {
  const Folder folder;
  for (const auto& s : samples) {
    const std::string text = s[1];
    for (std::size_t n = 0; n < text.size(); n += 3) judge(folder, s[0], text.substr(0, n));
  }
}

TEST(DamagedFiles, BytesScrambled) {
  const Folder folder;
  Random random(42);
  for (const auto& s : samples) {
    for (int k = 0; k < 60; ++k) {
      std::string text = s[1];
      for (int n = 0; n < 1 + k % 4; ++n) text[random.below(text.size())] = static_cast<char>(random.bits());
      judge(folder, s[0], text);
    }
  }
}

TEST(DamagedFiles, HugeCountsDoNotAskForMemory) {
  const Folder folder;
  judge(folder, "a.off", "OFF\n4000000000 1 0\n0 0 0\n");
  judge(folder, "b.off", "OFF\n-5 -7 0\n");
  judge(folder, "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 2000000000\nproperty double x\nproperty double y\nproperty double "
        "z\nend_header\n0 0 0\n");
  judge(folder, "a.asc", "ncols 2000000000\nnrows 2000000000\nxllcorner 0\nyllcorner 0\ncellsize 1\n1\n");
  judge(folder, "a.vtk",
        "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 3 double\n0 0 0 1 0 0 0 1 0\nPOLYGONS 1 4\n3 0 "
        "1 999999\n");
}

TEST(DamagedFiles, BinaryThatNobodyKnowsIsNotTakenForPoints) {
  const Folder folder;
  const FileReport r = check_file(folder.write("cut.tif", std::string("II*") + '\0' + " and then nothing\n"));
  EXPECT_EQ(r.verdict, MeshVerdict::refused);
  EXPECT_NE(r.refusal.find("damaged or cut short"), std::string::npos) << r.refusal;
}

}  // namespace
}  // namespace gdesp::geometry
