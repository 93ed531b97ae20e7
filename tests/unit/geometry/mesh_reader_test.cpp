// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh_reader.hpp"

#include <omp.h>

#include "support.hpp"

namespace gdesp::geometry {
namespace {

using testing::Folder;
using testing::input_error;

const char* const tetrahedron_off = "OFF\n4 4 0\n0 0 0\n3 0 0\n0 3 0\n0 0 3\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

std::string ascii_stl(const TriangleMesh& m) {
  std::string text = "solid s\n";
  for (const auto& t : m.triangle) {
    text += "facet normal 0 0 0\n outer loop\n";
    for (int c = 0; c < 3; ++c) {
      const Vec3d& v = m.vertex[t[c]];
      text += "  vertex " + std::to_string(v.x) + " " + std::to_string(v.y) + " " + std::to_string(v.z) + "\n";
    }
    text += " endloop\nendfacet\n";
  }
  return text + "endsolid s\n";
}

std::string binary_stl(const TriangleMesh& m) {
  std::string out(80, ' ');
  const auto put = [&](const auto& value) { out.append(reinterpret_cast<const char*>(&value), sizeof value); };
  put(static_cast<std::uint32_t>(m.triangle.size()));
  for (const auto& t : m.triangle) {
    for (int k = 0; k < 3; ++k) put(0.0f);
    for (int c = 0; c < 3; ++c) {
      for (int a = 0; a < 3; ++a) put(static_cast<float>(m.vertex[t[c]][a]));
    }
    put(static_cast<std::uint16_t>(0));
  }
  return out;
}

void expect_box(const TriangleMesh& m, double volume) {
  EXPECT_EQ(m.vertex.size(), 8u);
  EXPECT_EQ(m.triangle.size(), 12u);
  EXPECT_NEAR(std::abs(signed_volume(m)), volume, 1e-6 * volume);
  EXPECT_EQ(border_edges(m), 0u);
}

TEST(MeshReader, StlAsciiAndBinary) {
  const Folder folder;
  const TriangleMesh box = box_mesh({{1, 2, 3}, {2, 4, 6}});
  expect_box(read_mesh(folder.write("a.stl", ascii_stl(box))), 6.0);
  expect_box(read_mesh(folder.write("b.stl", binary_stl(box))), 6.0);
}

TEST(MeshReader, ObjPlyOff) {
  const Folder folder;
  const std::string obj =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
      "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  expect_box(read_mesh(folder.write("a.obj", obj)), 1.0);
  EXPECT_NEAR(signed_volume(read_mesh(folder.write("a.off", tetrahedron_off))), 4.5, 1e-12);
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n4751301.25 0 0\n4751302.25 0 0\n4751301.25 "
      "1 0\n3 0 1 2\n";
  const TriangleMesh m = read_mesh(folder.write("a.ply", ply));
  EXPECT_EQ(m.vertex[0].x, 4751301.25);  // double precision is kept
}

TEST(MeshReader, ScaleAndShift) {
  const Folder folder;
  MeshOptions o;
  o.scale = 0.001;
  o.translate = {10, 0, 0};
  const Box b = bounds(read_mesh(folder.write("a.off", tetrahedron_off), o));
  EXPECT_NEAR(b.lower.x, 10.0, 1e-15);
  EXPECT_NEAR(b.upper.x, 10.003, 1e-12);
}

TEST(MeshReader, VtkLegacyAndXml) {
  const Folder folder;
  const std::string vtk =
      "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 4 double\n0 0 0 3 0 0 0 3 0 0 0 3\nPOLYGONS 4 "
      "16\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
  EXPECT_NEAR(signed_volume(read_mesh(folder.write("a.vtk", vtk))), 4.5, 1e-12);
  const std::string vtp =
      "<?xml version=\"1.0\"?><VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\"><PolyData>"
      "<Piece NumberOfPoints=\"3\" NumberOfPolys=\"1\"><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" "
      "format=\"ascii\">"
      "0 0 0 1 0 0 0 1 0</DataArray></Points><Polys><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 "
      "1 2</DataArray>"
      "<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">3</DataArray></Polys></Piece></PolyData></VTKFile>";
  EXPECT_EQ(read_mesh(folder.write("a.vtp", vtp)).triangle.size(), 1u);
  const std::string vtu =
      "<?xml version=\"1.0\"?><VTKFile type=\"UnstructuredGrid\" version=\"0.1\" "
      "byte_order=\"LittleEndian\"><UnstructuredGrid>"
      "<Piece NumberOfPoints=\"4\" NumberOfCells=\"1\"><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" "
      "format=\"ascii\">"
      "0 0 0 3 0 0 0 3 0 0 0 3</DataArray></Points><Cells><DataArray type=\"Int32\" Name=\"connectivity\" "
      "format=\"ascii\">0 1 2 3</DataArray>"
      "<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">4</DataArray><DataArray type=\"UInt8\" "
      "Name=\"types\" format=\"ascii\">10</DataArray>"
      "</Cells></Piece></UnstructuredGrid></VTKFile>";
  EXPECT_NEAR(std::abs(signed_volume(read_mesh(folder.write("a.vtu", vtu)))), 4.5, 1e-12);  // the skin of a tetrahedron
}

TEST(MeshReader, GmshMsh2Msh4AndGeo) {
  const Folder folder;
  const std::string msh2 =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 3 0 0\n3 0 3 0\n4 0 0 3\n$EndNodes\n$Elements\n4\n"
      "1 2 2 0 1 1 3 2\n2 2 2 0 1 1 2 4\n3 2 2 0 1 1 4 3\n4 2 2 0 1 2 3 4\n$EndElements\n";
  EXPECT_NEAR(signed_volume(read_mesh(folder.write("a.msh", msh2))), 4.5, 1e-12);
  const std::string msh4 =
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 1 0\n1 0 0 0 3 3 3 0 0\n$EndEntities\n$Nodes\n1 4 1 4\n2 1 "
      "0 4\n1\n2\n3\n4\n"
      "0 0 0\n3 0 0\n0 3 0\n0 0 3\n$EndNodes\n$Elements\n1 4 1 4\n2 1 2 4\n1 1 3 2\n2 1 2 4\n3 1 4 3\n4 2 3 "
      "4\n$EndElements\n";
  EXPECT_NEAR(signed_volume(read_mesh(folder.write("b.msh", msh4))), 4.5, 1e-12);
  const int threads = omp_get_max_threads();
  omp_set_num_threads(3);
  const std::string geo =
      "Point(1)={0,0,0};Point(2)={1,0,0};Point(3)={1,1,0};Point(4)={0,1,0};\n"
      "Line(1)={1,2};Line(2)={2,3};Line(3)={3,4};Line(4)={4,1};Line Loop(1)={1,2,3,4};Plane Surface(1)={1};\n"
      "out[]=Extrude{0,0,2}{Surface{1};};\n";
  MeshOptions o;
  o.mesh_size = 0.5;
  TriangleMesh m = read_mesh(folder.write("c.geo", geo), o);
  EXPECT_EQ(border_edges(m), 0u);
  EXPECT_NEAR(surface_area(m), 2.0 + 8.0, 1e-9);
  EXPECT_EQ(omp_get_max_threads(), 3);  // gmsh sets it to one
  omp_set_num_threads(threads);
  EXPECT_MENTIONS(input_error([&] { read_mesh(folder.file("c.geo")); }), "mesh_size");
}

TEST(MeshReader, SaysWhatIsWrong) {
  const Folder folder;
  EXPECT_MENTIONS(input_error([&] { read_mesh(folder.file("none.stl")); }), "no such file");
  EXPECT_MENTIONS(input_error([&] { read_mesh(folder.write("a.xyzzy", "x")); }), "unknown mesh format \"xyzzy\"");
  for (const char* name : {"a.off", "a.obj", "a.ply", "a.stl", "a.vtk", "a.vtp", "a.vtu", "a.msh", "a.geo", "a.step"}) {
    const std::string path = folder.write(name, "this is no geometry at all, only words\n");
    MeshOptions o;
    o.mesh_size = 1.0;
    EXPECT_MENTIONS(input_error([&] { read_mesh(path, o); }), name);
  }
  std::string cut = binary_stl(box_mesh({{0, 0, 0}, {1, 1, 1}}));
  cut.resize(cut.size() - 70);
  EXPECT_MENTIONS(input_error([&] { read_mesh(folder.write("cut.stl", cut)); }), "12 facets");
  std::string ascii = ascii_stl(box_mesh({{0, 0, 0}, {1, 1, 1}}));
  ascii.resize(ascii.size() / 2);
  EXPECT_MENTIONS(input_error([&] { read_mesh(folder.write("cut2.stl", ascii)); }), "cut short");
  const std::string wild = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n";
  EXPECT_MENTIONS(input_error([&] { read_mesh(folder.write("wild.off", wild)); }), "wild.off");
  const std::string nan = "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n";
  EXPECT_MENTIONS(input_error([&] { read_mesh(folder.write("nan.obj", nan)); }), "nan.obj");
}

}  // namespace
}  // namespace gdesp::geometry
