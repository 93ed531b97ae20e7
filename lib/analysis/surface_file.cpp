// SPDX-License-Identifier: GPL-3.0-or-later
// The surface as a VTK file.
#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataWriter.h>

#include <cmath>
#include <filesystem>

#include "analysis/surface_mesh.hpp"
#include "core/error.hpp"

namespace gdesp::analysis {
namespace {

void add_field(vtkPolyData* data, const char* name, std::initializer_list<double> values) {
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  array->SetNumberOfComponents(static_cast<int>(values.size()));
  array->InsertNextTuple(values.begin());
  data->GetFieldData()->AddArray(array);
}

}  // namespace

void write_surface_vtp(const SurfaceMesh& mesh, const Vec3d& offset, double time, const std::string& path) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToFloat();
  points->SetNumberOfPoints(static_cast<vtkIdType>(mesh.vertex.size()));
  for (std::size_t k = 0; k < mesh.vertex.size(); ++k) {
    points->SetPoint(static_cast<vtkIdType>(k), mesh.vertex[k].x, mesh.vertex[k].y, mesh.vertex[k].z);
  }
  vtkNew<vtkCellArray> cells;
  for (const auto& t : mesh.triangle) {
    const vtkIdType corner[3] = {t.x, t.y, t.z};
    cells->InsertNextCell(3, corner);
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(cells);
  add_field(data, "TimeValue", {time});
  add_field(data, "offset", {offset.x, offset.y, offset.z});
  if (!mesh.velocity.empty()) {
    vtkNew<vtkFloatArray> velocity, speed;
    velocity->SetName("velocity");
    velocity->SetNumberOfComponents(3);
    speed->SetName("speed");
    for (const Vec3f& v : mesh.velocity) {
      velocity->InsertNextTuple3(v.x, v.y, v.z);
      speed->InsertNextValue(norm(v));
    }
    data->GetPointData()->AddArray(velocity);
    data->GetPointData()->SetScalars(speed);
  }
  vtkNew<vtkXMLPolyDataWriter> writer;
  const std::string aside = path + ".part";
  writer->SetFileName(aside.c_str());
  writer->SetInputData(data);
  writer->SetDataModeToBinary();
  writer->SetCompressorTypeToNone();
  if (!writer->Write()) {
    std::error_code ignored;
    std::filesystem::remove(aside, ignored);
    throw Error(ErrorKind::resource, path + ": cannot be written");
  }
  std::filesystem::rename(aside, path);
}

}  // namespace gdesp::analysis
