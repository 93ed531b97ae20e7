// SPDX-License-Identifier: GPL-3.0-or-later
// Files of other programs through VTK: VTP, VTU, legacy VTK. The one file of the module that sees VTK.
#include <vtkCell.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSetReader.h>
#include <vtkIdList.h>
#include <vtkLogger.h>
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

#include <cmath>
#include <mutex>
#include <string_view>

#include "core/error.hpp"
#include "io/point_source.hpp"
#include "io/foreign_guard.hpp"

namespace gdesp {
namespace {

/// Takes what VTK would print. VTK has one window for the process: the lock keeps readings apart.
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

std::mutex vtk_window_mutex;

/// The last line of a VTK message that says something, without addresses.
std::string told(const std::string& messages) {
  const std::size_t mark = messages.find("): ");
  std::string text = mark == std::string::npos ? messages : messages.substr(mark + 3);
  text = text.substr(0, text.find('\n'));
  return text.empty() ? "it is damaged" : text;
}

template <class Reader>
vtkSmartPointer<vtkPointSet> read_file(const std::string& path) {
  const std::lock_guard<std::mutex> lock(vtk_window_mutex);
  const vtkSmartPointer<vtkOutputWindow> before = vtkOutputWindow::GetInstance();
  const vtkNew<MessageCatcher> catcher;
  vtkOutputWindow::SetInstance(catcher);
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  vtkSmartPointer<vtkPointSet> data;
  unsigned long code = 0;
  try {
    const vtkNew<Reader> reader;
    reader->SetFileName(path.c_str());
    reader->Update();
    code = reader->GetErrorCode();
    data = vtkPointSet::SafeDownCast(reader->GetOutput());
  } catch (const std::exception& problem) {  // sizes that lie end in bad_alloc or length_error
    catcher->messages += std::string("): ") + problem.what();
  }
  vtkOutputWindow::SetInstance(before);
  if (code != 0 || !catcher->messages.empty())
    throw Error(ErrorKind::input, path + ": VTK cannot read it: " + told(catcher->messages));
  if (!data) throw Error(ErrorKind::input, path + ": holds no point set (expected polydata or an unstructured grid)");
  return data;
}

class VtkSource : public PointSource {
 public:
  VtkSource(std::string path, vtkSmartPointer<vtkPointSet> data) : path_(std::move(path)), data_(std::move(data)) {}

  std::size_t size() const override { return static_cast<std::size_t>(data_->GetNumberOfPoints()); }

  std::vector<Vec3d> positions() const override {
    std::vector<Vec3d> out(size());
    for (std::size_t i = 0; i < out.size(); ++i) {
      double xyz[3];
      data_->GetPoint(vtkIdType(i), xyz);
      out[i] = {xyz[0], xyz[1], xyz[2]};
    }
    return out;
  }

  std::vector<std::string> names() const override {
    std::vector<std::string> out;
    for (int i = 0; i < data_->GetPointData()->GetNumberOfArrays(); ++i)
      if (const char* name = data_->GetPointData()->GetArrayName(i)) out.emplace_back(name);
    return out;
  }

  int components(const std::string& name) const override {
    const vtkDataArray* a = data_->GetPointData()->GetArray(name.c_str());
    return a ? const_cast<vtkDataArray*>(a)->GetNumberOfComponents() : 0;
  }

  void read(const std::string& name, float* values) const override { copy(name, values); }
  void read(const std::string& name, std::int64_t* values) const override { copy(name, values); }

  std::vector<double> field(const std::string& name) const override {
    std::vector<double> out;
    vtkDataArray* a = data_->GetFieldData()->GetArray(name.c_str());
    if (!a) return out;
    for (vtkIdType i = 0; i < a->GetNumberOfTuples(); ++i)
      for (int k = 0; k < a->GetNumberOfComponents(); ++k) out.push_back(a->GetComponent(i, k));
    return out;
  }

  TriangleTable triangles() const override {
    TriangleTable table;
    table.vertex = positions();
    vtkDataArray* body = data_->GetCellData()->GetArray("body");
    const vtkNew<vtkIdList> corners;
    for (vtkIdType i = 0; i < data_->GetNumberOfCells(); ++i) {
      if (data_->GetCellType(i) == VTK_TRIANGLE_STRIP)
        throw Error(ErrorKind::input, path_ + ": holds triangle strips, expected triangles");
      data_->GetCellPoints(i, corners);
      const bool surface = data_->GetCellType(i) == VTK_TRIANGLE || data_->GetCellType(i) == VTK_POLYGON ||
                           data_->GetCellType(i) == VTK_QUAD;
      for (vtkIdType k = 2; surface && k < corners->GetNumberOfIds(); ++k) {
        table.triangle.push_back({vertex(corners->GetId(0)), vertex(corners->GetId(k - 1)), vertex(corners->GetId(k))});
        table.body.push_back(body ? static_cast<std::int32_t>(body->GetComponent(i, 0)) : 0);
      }
    }
    return table;
  }

 private:
  std::int32_t vertex(vtkIdType id) const {
    if (id < 0 || id >= data_->GetNumberOfPoints())
      throw Error(ErrorKind::input, path_ + ": a polygon names vertex " + std::to_string(id) + " of " +
                                        std::to_string(data_->GetNumberOfPoints()));
    return static_cast<std::int32_t>(id);
  }

  template <class T>
  void copy(const std::string& name, T* values) const {
    vtkDataArray* a = data_->GetPointData()->GetArray(name.c_str());
    const int parts = a->GetNumberOfComponents();
    if (a->GetNumberOfTuples() != data_->GetNumberOfPoints())
      throw Error(ErrorKind::input, path_ + ": field " + name + " has " + std::to_string(a->GetNumberOfTuples()) +
                                        " values for " + std::to_string(data_->GetNumberOfPoints()) + " points");
    for (vtkIdType i = 0; i < a->GetNumberOfTuples(); ++i)
      for (int k = 0; k < parts; ++k) {
        const double value = a->GetComponent(i, k);
        if constexpr (std::is_integral_v<T>)
          *values++ = value >= -9e15 && value <= 9e15 ? static_cast<T>(value) : T(-1);
        else
          *values++ = static_cast<T>(value);
      }
  }

  std::string path_;
  vtkSmartPointer<vtkPointSet> data_;
};

}  // namespace

std::unique_ptr<PointSource> open_with_vtk(const std::string& path) {
  refuse_implausible_vtk(path);
  vtkSmartPointer<vtkPointSet> data;
  if (path.ends_with(".vtp")) data = read_file<vtkXMLPolyDataReader>(path);
  else if (path.ends_with(".vtu")) data = read_file<vtkXMLUnstructuredGridReader>(path);
  else data = read_file<vtkDataSetReader>(path);
  return std::make_unique<VtkSource>(path, data);
}

}  // namespace gdesp
