// SPDX-License-Identifier: GPL-3.0-or-later
// Points in OpenVDB files. The one file of the module that sees OpenVDB.
#include <openvdb/openvdb.h>
#include <openvdb/points/PointConversion.h>
#include <openvdb/points/PointCount.h>

#include "core/error.hpp"
#include "io/foreign_guard.hpp"
#include "io/isolated.hpp"

namespace gdesp {
namespace {

using openvdb::points::AttributeHandle;
using openvdb::points::AttributeSet;
using openvdb::points::PointDataGrid;

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

void take_positions(const PointDataGrid& grid, MemoryPoints& points) {
  points.position.reserve(openvdb::points::pointCount(grid.tree()));
  for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
    const AttributeHandle<openvdb::Vec3f> position(leaf->constAttributeArray("P"));
    for (auto index = leaf->beginIndexOn(); index; ++index) {
      const openvdb::Vec3d at =
          grid.transform().indexToWorld(openvdb::Vec3d(position.get(*index)) + index.getCoord().asVec3d());
      points.position.push_back({at.x(), at.y(), at.z()});
    }
  }
}

/// Appends the attribute of every point; Value is its type in the file, Item the type kept.
template <class Value, class Item>
void take(const PointDataGrid& grid, const std::string& name, std::vector<Item>& out) {
  for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
    const AttributeHandle<Value> handle(leaf->constAttributeArray(name));
    for (auto index = leaf->beginIndexOn(); index; ++index) {
      const Value value = handle.get(*index);
      if constexpr (openvdb::VecTraits<Value>::IsVec)
        for (int k = 0; k < 3; ++k) out.push_back(static_cast<Item>(value[k]));
      else
        out.push_back(static_cast<Item>(value));
    }
  }
}

void take_column(const PointDataGrid& grid, const std::string& name, const std::string& type, MemoryPoints& points) {
  MemoryColumn column{name, type.starts_with("vec3") ? 3 : 1, {}, {}};
  if (type == "float")
    take<float>(grid, name, column.numbers);
  else if (type == "double")
    take<double>(grid, name, column.numbers);
  else if (type == "vec3s")
    take<openvdb::Vec3f>(grid, name, column.numbers);
  else if (type == "vec3d")
    take<openvdb::Vec3d>(grid, name, column.numbers);
  else if (type == "int32")
    take<std::int32_t>(grid, name, column.integers);
  else if (type == "int64")
    take<std::int64_t>(grid, name, column.integers);
  else
    return;
  points.columns.push_back(std::move(column));
}

void take_fields(const PointDataGrid& grid, MemoryPoints& points) {
  for (auto entry = grid.beginMeta(); entry != grid.endMeta(); ++entry) {
    const openvdb::Metadata& value = *entry->second;
    if (const auto* number = dynamic_cast<const openvdb::FloatMetadata*>(&value))
      points.fields.push_back({entry->first, {double(number->value())}});
    if (const auto* number = dynamic_cast<const openvdb::DoubleMetadata*>(&value))
      points.fields.push_back({entry->first, {number->value()}});
    if (const auto* v = dynamic_cast<const openvdb::Vec3DMetadata*>(&value))
      points.fields.push_back({entry->first, {v->value().x(), v->value().y(), v->value().z()}});
  }
}

void read_by_openvdb(const std::string& path, MemoryPoints& points) {
  refuse_torn_vdb(path);
  const PointDataGrid::Ptr grid = first_point_grid(path);
  take_fields(*grid, points);
  const auto leaf = grid->tree().cbeginLeaf();
  if (!leaf) return;
  const AttributeSet& attributes = leaf->attributeSet();
  if (attributes.find("P") == AttributeSet::INVALID_POS)
    throw Error(ErrorKind::input, path + ": its points have no position attribute \"P\"");
  take_positions(*grid, points);
  for (const auto& [name, position] : attributes.descriptor().map())
    if (name != "P") take_column(*grid, name, std::string(attributes.get(position)->type().first), points);
}

}  // namespace

std::unique_ptr<PointSource> open_vdb_points(const std::string& path) {
  return read_isolated(path, "OpenVDB", read_by_openvdb);
}

}  // namespace gdesp
