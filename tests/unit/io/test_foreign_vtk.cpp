// SPDX-License-Identifier: GPL-3.0-or-later
// Files as other programs write them with VTK: other encodings, number types and data sets; and those files torn.
#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataWriter.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridWriter.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include "io/point_source.hpp"
#include "io_fixture.hpp"

namespace gdesp::test {
namespace {

constexpr int count = 500;

/// Float points, double velocity "Vel", integer "Idp", time as ParaView names it.
void fill(vtkPointSet* data) {
  const vtkNew<vtkPoints> points;
  points->SetDataTypeToFloat();
  const vtkNew<vtkDoubleArray> velocity;
  velocity->SetName("Vel");
  velocity->SetNumberOfComponents(3);
  const vtkNew<vtkFloatArray> density;
  density->SetName("Rhop");
  const vtkNew<vtkIntArray> number;
  number->SetName("Idp");
  for (int i = 0; i < count; ++i) {
    points->InsertNextPoint(0.5 * i, 1.0, -0.25 * i);
    velocity->InsertNextTuple3(i, 2.0 * i, 3.0);
    density->InsertNextValue(1000.0f + float(i));
    number->InsertNextValue(count - i);
  }
  data->SetPoints(points);
  data->GetPointData()->AddArray(velocity);
  data->GetPointData()->AddArray(density);
  data->GetPointData()->AddArray(number);
  const vtkNew<vtkDoubleArray> time;
  time->SetName("TimeValue");
  time->InsertNextValue(2.5);
  data->GetFieldData()->AddArray(time);
}

template <class Data>
vtkSmartPointer<Data> some_data() {
  const auto data = vtkSmartPointer<Data>::New();
  fill(data);
  const vtkNew<vtkCellArray> cells;
  for (vtkIdType i = 0; i < count; ++i) cells->InsertNextCell(1, &i);
  if constexpr (std::is_same_v<Data, vtkPolyData>)
    data->SetVerts(cells);
  else
    data->SetCells(VTK_VERTEX, cells);
  return data;
}

void expect_read(const std::string& path) {
  const std::vector<FieldMapping> mapping{{"velocity", "Vel"}, {"density", "Rhop"}, {"id", "Idp"}};
  FrameMeta meta;
  const FluidTable f = read_fluid_frame(path, mapping, &meta);
  ASSERT_EQ(f.position.size(), std::size_t(count)) << path;
  EXPECT_EQ(f.position[100], (Vec3d{50.0, 1.0, -25.0}));
  EXPECT_EQ(f.velocity[100], (Vec3f{100.0f, 200.0f, 3.0f}));
  EXPECT_EQ(f.density[100], 1100.0f);
  EXPECT_EQ(f.id[100], std::uint32_t(count - 100));
  EXPECT_TRUE(f.pressure.empty());
  EXPECT_TRUE(meta.has_time) << path;
  EXPECT_EQ(meta.time, 2.5);
}

/// Cuts the file at many places; every piece must be refused as input.
void expect_torn_refused(const TempFolder& folder, const std::string& path) {
  const std::string text = text_of_file(path), ending = path.substr(path.rfind('.'));
  for (int i = 0; i < 16; ++i) {
    const std::string torn = folder.write("torn" + ending, text.substr(0, text.size() * std::size_t(i) / 17));
    expect_error(ErrorKind::input, {"torn" + ending}, [&] { read_fluid_frame(torn, {}, nullptr); });
  }
}

template <class Writer, class Data>
std::string write_xml(const TempFolder& folder, const std::string& name, Data* data, int mode, int compressor) {
  const vtkNew<Writer> writer;
  writer->SetInputData(data);
  writer->SetFileName((folder / name).c_str());
  writer->SetDataMode(mode);
  writer->SetCompressorType(compressor);
  EXPECT_EQ(writer->Write(), 1);
  return folder / name;
}

TEST(ForeignVtk, xml_in_every_encoding) {
  const TempFolder folder;
  using Writer = vtkXMLPolyDataWriter;
  const auto data = some_data<vtkPolyData>();
  for (const int mode : {vtkXMLWriter::Ascii, vtkXMLWriter::Binary, vtkXMLWriter::Appended})
    for (const int compressor : {vtkXMLWriter::NONE, vtkXMLWriter::ZLIB, vtkXMLWriter::LZ4}) {
      const std::string path = write_xml<Writer>(folder, "p.vtp", data.Get(), mode, compressor);
      expect_read(path);
      expect_torn_refused(folder, path);
    }
}

TEST(ForeignVtk, plain_binary_by_vtk_needs_no_vtk) {
  const TempFolder folder;
  const std::string path = write_xml<vtkXMLPolyDataWriter>(folder, "p.vtp", some_data<vtkPolyData>().Get(),
                                                           vtkXMLWriter::Binary, vtkXMLWriter::NONE);
  const std::unique_ptr<PointSource> source = open_plain_vtp(path);
  ASSERT_TRUE(source);
  EXPECT_EQ(source->size(), std::size_t(count));
  EXPECT_EQ(source->components("Vel"), 3);
}

TEST(ForeignVtk, unstructured_grid) {
  const TempFolder folder;
  const auto data = some_data<vtkUnstructuredGrid>();
  for (const int mode : {vtkXMLWriter::Ascii, vtkXMLWriter::Binary, vtkXMLWriter::Appended}) {
    const std::string path =
        write_xml<vtkXMLUnstructuredGridWriter>(folder, "u.vtu", data.Get(), mode, vtkXMLWriter::ZLIB);
    expect_read(path);
    expect_torn_refused(folder, path);
  }
}

template <class Writer, class Data>
void check_legacy(const TempFolder& folder, Data* data, bool binary) {
  const vtkNew<Writer> writer;
  writer->SetInputData(data);
  writer->SetFileName((folder / "l.vtk").c_str());
  if (binary) writer->SetFileTypeToBinary();
  ASSERT_EQ(writer->Write(), 1);
  expect_read(folder / "l.vtk");
}

TEST(ForeignVtk, legacy) {
  const TempFolder folder;
  for (const bool binary : {false, true}) {
    check_legacy<vtkPolyDataWriter>(folder, some_data<vtkPolyData>().Get(), binary);
    check_legacy<vtkUnstructuredGridWriter>(folder, some_data<vtkUnstructuredGrid>().Get(), binary);
  }
}

/// A legacy file has no end mark: torn at the border of two arrays it is sound. No piece may do harm.
TEST(ForeignVtk, torn_legacy) {
  const TempFolder folder;
  check_legacy<vtkPolyDataWriter>(folder, some_data<vtkPolyData>().Get(), true);
  const std::string text = text_of_file(folder / "l.vtk");
  int refused = 0;
  for (std::size_t length = 0; length < text.size(); length += text.size() / 60 + 1) {
    try {
      const FluidTable f = read_fluid_frame(folder.write("t.vtk", text.substr(0, length)), {}, nullptr);
      EXPECT_LE(f.position.size(), std::size_t(count));
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      ++refused;
    }
  }
  EXPECT_GT(refused, 15);
}

/// Changes of this kind bring VTK 9.1 down; here they end in an error.
TEST(ForeignVtk, changed_bytes_do_no_harm) {
  const TempFolder folder;
  expect_changed_bytes_do_no_harm(
      folder,
      write_xml<vtkXMLUnstructuredGridWriter>(folder, "u.vtu", some_data<vtkUnstructuredGrid>().Get(),
                                              vtkXMLWriter::Binary, vtkXMLWriter::LZ4),
      40);
  check_legacy<vtkPolyDataWriter>(folder, some_data<vtkPolyData>().Get(), true);
  expect_changed_bytes_do_no_harm(folder, folder / "l.vtk", 40);
}

TEST(ForeignVtk, sizes_that_lie_take_no_memory) {
  const TempFolder folder;
  const std::string legacy =
      "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 99999999999 float\n0 0 0\n";
  expect_error(ErrorKind::input, {"POINTS", "99999999999"},
               [&] { read_fluid_frame(folder.write("a.vtk", legacy), {}, nullptr); });
  const std::string xml =
      "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\"><UnstructuredGrid>"
      "<Piece NumberOfPoints=\"99999999999\" "
      "NumberOfCells=\"0\"><Points></Points></Piece></UnstructuredGrid></VTKFile>";
  expect_error(ErrorKind::input, {"NumberOfPoints", "99999999999"},
               [&] { read_fluid_frame(folder.write("a.vtu", xml), {}, nullptr); });
}

TEST(ForeignVtk, what_is_no_vtk_file) {
  const TempFolder folder;
  for (const char* name : {"a.vtk", "a.vtu", "a.vtp"}) {
    expect_error(ErrorKind::input, {name, "no such file"}, [&] { read_fluid_frame(folder / name, {}, nullptr); });
    expect_error(ErrorKind::input, {name}, [&] { read_fluid_frame(folder.write(name, "hello\n"), {}, nullptr); });
    expect_error(ErrorKind::input, {name}, [&] { read_fluid_frame(folder.write(name, ""), {}, nullptr); });
    std::filesystem::remove(folder / name);
  }
  const std::string image =
      "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 1\nORIGIN 0 0 0\nSPACING 1 1 "
      "1\n";
  expect_error(ErrorKind::input, {"image.vtk", "no point set"},
               [&] { read_fluid_frame(folder.write("image.vtk", image), {}, nullptr); });
}

}  // namespace
}  // namespace gdesp::test
