// SPDX-License-Identifier: GPL-3.0-or-later
// Points in OpenVDB files. The one file of the module that sees OpenVDB.
#include <openvdb/openvdb.h>
#include <openvdb/points/PointConversion.h>
#include <openvdb/points/PointCount.h>

#include "core/error.hpp"
#include "io/point_source.hpp"
#include "io/foreign_guard.hpp"

namespace gdesp {
namespace {

using openvdb::points::AttributeHandle;
using openvdb::points::AttributeSet;
using openvdb::points::PointDataGrid;
using openvdb::points::PointDataTree;

class VdbSource : public PointSource {
 public:
  VdbSource(std::string path, PointDataGrid::Ptr grid)
      : path_(std::move(path)), grid_(std::move(grid)), size_(openvdb::points::pointCount(grid_->tree())) {
    if (size_ > 0 && attributes()->find("P") == AttributeSet::INVALID_POS)
      throw Error(ErrorKind::input, path_ + ": its points have no position attribute \"P\"");
  }

  std::size_t size() const override { return size_; }

  std::vector<Vec3d> positions() const override {
    std::vector<Vec3d> out;
    out.reserve(size_);
    for (auto leaf = grid_->tree().cbeginLeaf(); leaf; ++leaf) {
      const AttributeHandle<openvdb::Vec3f> position(leaf->constAttributeArray("P"));
      for (auto index = leaf->beginIndexOn(); index; ++index) {
        const openvdb::Vec3d at = grid_->transform().indexToWorld(openvdb::Vec3d(position.get(*index)) +
                                                                  index.getCoord().asVec3d());
        out.push_back({at.x(), at.y(), at.z()});
      }
    }
    return out;
  }

  std::vector<std::string> names() const override {
    std::vector<std::string> out;
    if (const AttributeSet* set = attributes())
      for (const auto& entry : set->descriptor().map()) if (entry.first != "P") out.push_back(entry.first);
    return out;
  }

  int components(const std::string& name) const override {
    const std::string type = type_of(name);
    if (type.empty()) return 0;
    return type.starts_with("vec3") ? 3 : 1;
  }

  void read(const std::string& name, float* values) const override { copy(name, values); }
  void read(const std::string& name, std::int64_t* values) const override { copy(name, values); }

  std::vector<double> field(const std::string& name) const override {
    if (const auto number = grid_->getMetadata<openvdb::FloatMetadata>(name)) return {double(number->value())};
    if (const auto number = grid_->getMetadata<openvdb::DoubleMetadata>(name)) return {number->value()};
    if (const auto vector = grid_->getMetadata<openvdb::Vec3DMetadata>(name))
      return {vector->value().x(), vector->value().y(), vector->value().z()};
    return {};
  }

  TriangleTable triangles() const override { return {}; }

 private:
  const AttributeSet* attributes() const {
    const auto leaf = grid_->tree().cbeginLeaf();
    return leaf ? &leaf->attributeSet() : nullptr;
  }

  std::string type_of(const std::string& name) const {
    const AttributeSet* set = attributes();
    const std::size_t position = set ? set->find(name) : AttributeSet::INVALID_POS;
    return position == AttributeSet::INVALID_POS ? std::string() : set->get(position)->type().first;
  }

  template <class Value, class T>
  void copy_as(const std::string& name, T* values) const {
    for (auto leaf = grid_->tree().cbeginLeaf(); leaf; ++leaf) {
      const AttributeHandle<Value> handle(leaf->constAttributeArray(name));
      for (auto index = leaf->beginIndexOn(); index; ++index) {
        const Value value = handle.get(*index);
        if constexpr (openvdb::VecTraits<Value>::IsVec)
          for (int k = 0; k < 3; ++k) *values++ = static_cast<T>(value[k]);
        else
          *values++ = static_cast<T>(value);
      }
    }
  }

  template <class T>
  void copy(const std::string& name, T* values) const {
    try {
      copy_by_type(name, values);
    } catch (const openvdb::Exception& problem) {
      throw Error(ErrorKind::input, path_ + ": attribute " + name + ": " + problem.what());
    }
  }

  template <class T>
  void copy_by_type(const std::string& name, T* values) const {
    const std::string type = type_of(name);
    if (type == "float") copy_as<float>(name, values);
    else if (type == "double") copy_as<double>(name, values);
    else if (type == "int32") copy_as<std::int32_t>(name, values);
    else if (type == "int64") copy_as<std::int64_t>(name, values);
    else if (type == "vec3s") copy_as<openvdb::Vec3f>(name, values);
    else if (type == "vec3d") copy_as<openvdb::Vec3d>(name, values);
    else
      throw Error(ErrorKind::input, path_ + ": attribute " + name + " is of type " + type +
                                        ", expected float, double, int32, int64, vec3s or vec3d");
  }

  std::string path_;
  PointDataGrid::Ptr grid_;
  std::size_t size_;
};

PointDataGrid::Ptr first_point_grid(const std::string& path) {
  openvdb::initialize();
  openvdb::io::File file(path);
  file.setCopyMaxBytes(0);
  file.open(false);
  for (auto name = file.beginName(); name != file.endName(); ++name) {
    const openvdb::GridBase::Ptr meta = file.readGridMetadata(*name);
    if (!meta->isType<PointDataGrid>()) continue;
    return openvdb::gridPtrCast<PointDataGrid>(file.readGrid(*name));
  }
  throw Error(ErrorKind::input, path + ": holds no point grid (expected an OpenVDB points file)");
}

}  // namespace

std::unique_ptr<PointSource> open_vdb_points(const std::string& path) {
  refuse_torn_vdb(path);
  try {
    return std::make_unique<VdbSource>(path, first_point_grid(path));
  } catch (const openvdb::Exception& problem) {
    throw Error(ErrorKind::input, path + ": OpenVDB cannot read it: " + problem.what());
  }
}

}  // namespace gdesp
