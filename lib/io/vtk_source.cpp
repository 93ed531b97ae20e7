// SPDX-License-Identifier: GPL-3.0-or-later
// Files of other programs through VTK: VTP, VTU, legacy VTK. The one file of the module that sees VTK.
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSetReader.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <algorithm>
#include <string_view>

#include "core/error.hpp"
#include "io/foreign_guard.hpp"
#include "io/isolated.hpp"

namespace gdesp {
namespace {

/// Takes what VTK would print. It stays in place: all this runs in a child process of its own.
class MessageCatcher : public vtkOutputWindow {
 public:
  static MessageCatcher* New();
  vtkTypeMacro(MessageCatcher, vtkOutputWindow);
  void DisplayText(const char* text) override { keep(text); }
  void DisplayErrorText(const char* text) override { keep(text); }
  void DisplayWarningText(const char* text) override { keep_if_error(text); }
  void DisplayGenericWarningText(const char* text) override { keep_if_error(text); }
  void DisplayDebugText(const char*) override {}
  std::string messages;

 private:
  /// The legacy reader warns "Error reading binary data!" and goes on.
  void keep_if_error(const char* text) {
    if (std::string_view(text).find("rror") != std::string_view::npos) keep(text);
  }
  void keep(const char* text) {
    if (messages.size() < 2000) messages += text;
  }
};
vtkStandardNewMacro(MessageCatcher);

/// The first line of a VTK message that says something, without addresses.
std::string told(const std::string& messages) {
  const std::size_t mark = messages.find("): ");
  std::string text = mark == std::string::npos ? messages : messages.substr(mark + 3);
  text.erase(std::min(text.find('\n'), text.size()));
  return text.empty() ? "it is damaged" : text;
}

// A legacy file names one array of a kind as the one to be read; others stand beside it.
void read_all_arrays(vtkDataSetReader& reader) {
  reader.ReadAllScalarsOn();
  reader.ReadAllVectorsOn();
  reader.ReadAllNormalsOn();
  reader.ReadAllTensorsOn();
  reader.ReadAllFieldsOn();
}
void read_all_arrays(vtkXMLReader&) {}

template <class Reader>
vtkSmartPointer<vtkPointSet> read_file(const std::string& path) {
  const vtkNew<MessageCatcher> catcher;
  vtkOutputWindow::SetInstance(catcher);
  const vtkNew<Reader> reader;
  reader->SetFileName(path.c_str());
  read_all_arrays(*reader);
  reader->Update();
  vtkSmartPointer<vtkPointSet> data = vtkPointSet::SafeDownCast(reader->GetOutput());
  if (reader->GetErrorCode() != 0 || !catcher->messages.empty())
    throw Error(ErrorKind::input, path + ": VTK cannot read it: " + told(catcher->messages));
  if (!data) throw Error(ErrorKind::input, path + ": holds no point set (expected polydata or an unstructured grid)");
  return data;
}

bool holds_integers(vtkDataArray& a) { return a.GetDataType() != VTK_FLOAT && a.GetDataType() != VTK_DOUBLE; }

void take_columns(const std::string& path, vtkPointSet& data, MemoryPoints& points) {
  for (int i = 0; i < data.GetPointData()->GetNumberOfArrays(); ++i) {
    vtkDataArray* a = data.GetPointData()->GetArray(i);
    if (!a || !a->GetName()) continue;
    if (a->GetNumberOfTuples() != data.GetNumberOfPoints())
      throw Error(ErrorKind::input, path + ": field " + a->GetName() + " has " +
                                        std::to_string(a->GetNumberOfTuples()) + " values for " +
                                        std::to_string(data.GetNumberOfPoints()) + " points");
    MemoryColumn column{a->GetName(), a->GetNumberOfComponents(), {}, {}};
    const auto values = std::size_t(a->GetNumberOfTuples()) * std::size_t(column.components);
    if (holds_integers(*a))
      column.integers.reserve(values);
    else
      column.numbers.reserve(values);
    for (vtkIdType k = 0; k < a->GetNumberOfTuples(); ++k)
      for (int c = 0; c < column.components; ++c) {
        const double value = a->GetComponent(k, c);
        if (holds_integers(*a))
          column.integers.push_back(value >= -9e15 && value <= 9e15 ? std::int64_t(value) : -1);
        else
          column.numbers.push_back(static_cast<float>(value));
      }
    points.columns.push_back(std::move(column));
  }
}

void take_fields(vtkPointSet& data, MemoryPoints& points) {
  for (int i = 0; i < data.GetFieldData()->GetNumberOfArrays(); ++i) {
    vtkDataArray* a = data.GetFieldData()->GetArray(i);
    if (!a || !a->GetName()) continue;
    MemoryField field{a->GetName(), {}};
    for (vtkIdType k = 0; k < a->GetNumberOfTuples(); ++k)
      for (int c = 0; c < a->GetNumberOfComponents(); ++c) field.values.push_back(a->GetComponent(k, c));
    points.fields.push_back(std::move(field));
  }
}

void take_triangles(const std::string& path, vtkPointSet& data, MemoryPoints& points) {
  vtkDataArray *body = data.GetCellData()->GetArray("body"), *smooth = data.GetCellData()->GetArray("smooth");
  const vtkNew<vtkIdList> corners;
  const auto vertex = [&](vtkIdType k) {
    const vtkIdType id = corners->GetId(k);
    if (id < 0 || id >= data.GetNumberOfPoints())
      throw Error(ErrorKind::input, path + ": a polygon names vertex " + std::to_string(id) + " of " +
                                        std::to_string(data.GetNumberOfPoints()));
    return static_cast<std::int32_t>(id);
  };
  for (vtkIdType i = 0; i < data.GetNumberOfCells(); ++i) {
    const int type = data.GetCellType(i);
    if (type == VTK_TRIANGLE_STRIP) throw Error(ErrorKind::input, path + ": holds triangle strips, expected triangles");
    if (type != VTK_TRIANGLE && type != VTK_POLYGON && type != VTK_QUAD) continue;
    data.GetCellPoints(i, corners);
    for (vtkIdType k = 2; k < corners->GetNumberOfIds(); ++k) {
      points.surface.triangle.push_back({vertex(0), vertex(k - 1), vertex(k)});
      points.surface.body.push_back(body ? static_cast<std::int32_t>(body->GetComponent(i, 0)) : 0);
      if (smooth) points.surface.smooth.push_back(static_cast<std::int32_t>(smooth->GetComponent(i, 0)));
    }
  }
}

void read_by_vtk(const std::string& path, MemoryPoints& points) {
  refuse_implausible_vtk(path);
  vtkSmartPointer<vtkPointSet> data;
  if (path.ends_with(".vtp"))
    data = read_file<vtkXMLPolyDataReader>(path);
  else if (path.ends_with(".vtu"))
    data = read_file<vtkXMLUnstructuredGridReader>(path);
  else
    data = read_file<vtkDataSetReader>(path);
  points.position.resize(static_cast<std::size_t>(data->GetNumberOfPoints()));
  for (std::size_t i = 0; i < points.position.size(); ++i) {
    double xyz[3];
    data->GetPoint(vtkIdType(i), xyz);
    points.position[i] = {xyz[0], xyz[1], xyz[2]};
  }
  take_columns(path, *data, points);
  take_fields(*data, points);
  take_triangles(path, *data, points);
}

}  // namespace

std::unique_ptr<PointSource> open_with_vtk(const std::string& path) { return read_isolated(path, "VTK", read_by_vtk); }

}  // namespace gdesp
