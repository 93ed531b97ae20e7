// SPDX-License-Identifier: GPL-3.0-or-later
#include <vtkCellArray.h>
#include <vtkDataSet.h>
#include <vtkErrorCode.h>
#include <vtkGenericDataObjectReader.h>
#include <vtkGeometryFilter.h>
#include <vtkObject.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkTriangleFilter.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include "core/error.hpp"
#include "geometry/mesh_reader.hpp"
#include "io/foreign_guard.hpp"
#include "io/isolated.hpp"

namespace gdesp::geometry {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw Error(ErrorKind::input, path + ": " + why);
}

template <class Reader>
vtkSmartPointer<vtkDataSet> read_with(const std::string& path) {
  const auto reader = vtkSmartPointer<Reader>::New();
  reader->SetFileName(path.c_str());
  reader->Update();
  if (reader->GetErrorCode() != vtkErrorCode::NoError) return nullptr;
  return vtkDataSet::SafeDownCast(reader->GetOutputDataObject(0));
}

vtkSmartPointer<vtkDataSet> read_data_set(const std::string& path) {
  const auto ends_in = [&](const char* e) { return path.size() > 4 && path.compare(path.size() - 4, 4, e) == 0; };
  if (ends_in(".vtp")) return read_with<vtkXMLPolyDataReader>(path);
  if (ends_in(".vtu")) return read_with<vtkXMLUnstructuredGridReader>(path);
  return read_with<vtkGenericDataObjectReader>(path);
}

/// In a child process: VTK follows whatever a damaged file says.
void read_surface(const std::string& path, MemoryPoints& out) {
  refuse_implausible_vtk(path);
  vtkObject::GlobalWarningDisplayOff();  // problems are told by the error below, not printed
  const auto data = read_data_set(path);
  if (!data || data->GetNumberOfPoints() == 0) refuse(path, "is damaged, cut short, or no VTK file with points");
  const auto surface = vtkSmartPointer<vtkGeometryFilter>::New();
  surface->SetInputData(data);
  const auto triangles = vtkSmartPointer<vtkTriangleFilter>::New();
  triangles->SetInputConnection(surface->GetOutputPort());
  triangles->PassVertsOff();
  triangles->PassLinesOff();
  triangles->Update();
  vtkPolyData* poly = triangles->GetOutput();
  const vtkIdType n = poly->GetNumberOfPoints();
  out.position.reserve(static_cast<std::size_t>(n));
  for (vtkIdType i = 0; i < n; ++i) {
    double p[3];
    poly->GetPoint(i, p);
    out.position.push_back({p[0], p[1], p[2]});
  }
  vtkCellArray* polys = poly->GetPolys();
  polys->InitTraversal();
  vtkIdType count = 0;
  const vtkIdType* corner = nullptr;
  while (polys->GetNextCell(count, corner)) {
    if (count != 3) continue;
    for (int c = 0; c < 3; ++c) {
      if (corner[c] < 0 || corner[c] >= n)
        refuse(path, "a cell names point " + std::to_string(corner[c]) + " of " + std::to_string(n));
    }
    out.surface.triangle.push_back({static_cast<std::int32_t>(corner[0]), static_cast<std::int32_t>(corner[1]),
                                    static_cast<std::int32_t>(corner[2])});
  }
  out.surface.body.assign(out.surface.triangle.size(), 0);
}

}  // namespace

TriangleMesh read_mesh_vtk(const std::string& path) {
  const auto points = read_isolated(path, "VTK", read_surface);
  return {std::move(points->position), std::move(points->surface.triangle)};
}

}  // namespace gdesp::geometry
