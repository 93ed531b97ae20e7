// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/tables.hpp"

#include <cmath>
#include <cstring>

#include "core/error.hpp"
#include "core/text.hpp"

namespace gdesp {
namespace {

/// Reads columns by this project's names, through the user's mapping.
class Columns {
 public:
  Columns(const PointSource& source, const std::string& path, const std::vector<FieldMapping>& mapping)
      : source_(source), path_(path), mapping_(mapping) {
    for (const FieldMapping& m : mapping)
      if (source.components(m.theirs) == 0)
        throw Error(ErrorKind::input,
                    path + ": has no field \"" + m.theirs + "\" for " + m.ours + "; it has: " + join(source.names()));
  }

  void read(const char* name, std::vector<float>& out) const { read_as<float>(name, 1, out); }
  void read(const char* name, std::vector<Vec3f>& out) const { read_as<float>(name, 3, out); }

  template <class Int>
  void read_integers(const char* name, std::vector<Int>& out) const {
    std::vector<std::int64_t> wide;
    read_as<std::int64_t>(name, 1, wide);
    out.resize(wide.size());
    for (std::size_t i = 0; i < wide.size(); ++i) {
      if (wide[i] < std::int64_t(std::numeric_limits<Int>::min()) ||
          wide[i] > std::int64_t(std::numeric_limits<Int>::max()))
        throw Error(ErrorKind::input, path_ + ": " + name + " of point " + std::to_string(i) + " is out of range");
      out[i] = static_cast<Int>(wide[i]);
    }
  }

  std::vector<Vec3d> positions() const {
    std::vector<Vec3d> out = source_.positions();
    for (std::size_t i = 0; i < out.size(); ++i)
      if (!std::isfinite(out[i].x + out[i].y + out[i].z))
        throw Error(ErrorKind::input, path_ + ": the position of point " + std::to_string(i) + " is not finite");
    return out;
  }

  bool has(const char* name) const { return source_.components(theirs(name)) != 0; }

 private:
  std::string theirs(const char* name) const {
    for (const FieldMapping& m : mapping_)
      if (m.ours == name) return m.theirs;
    return name;
  }

  template <class Number, class Item>
  void read_as(const char* name, int components, std::vector<Item>& out) const {
    static_assert(sizeof(Item) % sizeof(Number) == 0);
    const std::string column = theirs(name);
    const int found = source_.components(column);
    if (found == 0) return;
    if (found != components)
      throw Error(ErrorKind::input, path_ + ": field " + column + " has " + std::to_string(found) +
                                        " components, expected " + std::to_string(components));
    out.resize(source_.size());
    source_.read(column, reinterpret_cast<Number*>(out.data()));
  }

  const PointSource& source_;
  const std::string& path_;
  const std::vector<FieldMapping>& mapping_;
};

}  // namespace

void write_fluid(const std::string& path, const FluidTable& f, std::vector<VtpArray> field) {
  VtpContent content;
  content.position = &f.position;
  content.field = std::move(field);
  content.points = {vtp_array("velocity", f.velocity), vtp_array("density", f.density),
                    vtp_array("pressure", f.pressure), vtp_array("porosity", f.porosity), vtp_array("id", f.id)};
  write_vtp(path, content);
}

void write_grains(const std::string& path, const GrainTable& g, std::vector<VtpArray> field) {
  VtpContent content;
  content.position = &g.position;
  content.field = std::move(field);
  content.points = {vtp_array("diameter", g.diameter), vtp_array("density", g.density),
                    vtp_array("velocity", g.velocity), vtp_array("angular_velocity", g.angular_velocity),
                    vtp_array("group", g.group),       vtp_array("id", g.id),
                    vtp_array("porosity", g.porosity)};
  write_vtp(path, content);
}

void write_boundary(const std::string& path, const BoundaryTable& b, std::vector<VtpArray> field) {
  VtpContent content;
  content.position = &b.position;
  content.field = std::move(field);
  content.points = {vtp_array("normal", b.normal),     vtp_array("depth", b.depth),
                    vtp_array("friction", b.friction), vtp_array("body", b.body),
                    vtp_array("velocity", b.velocity), vtp_array("pressure", b.pressure)};
  write_vtp(path, content);
}

void write_triangles(const std::string& path, const TriangleTable& t, std::vector<VtpArray> field) {
  VtpContent content;
  content.position = &t.vertex;
  content.triangles = &t.triangle;
  content.field = std::move(field);
  content.cells = {vtp_array("body", t.body)};
  if (!t.smooth.empty()) content.cells.push_back(vtp_array("smooth", t.smooth));
  write_vtp(path, content);
}

FluidTable fluid_of(const PointSource& source, const std::string& path, const std::vector<FieldMapping>& mapping) {
  const Columns columns(source, path, mapping);
  FluidTable f;
  f.position = columns.positions();
  columns.read("velocity", f.velocity);
  columns.read("density", f.density);
  columns.read("pressure", f.pressure);
  columns.read("porosity", f.porosity);
  columns.read_integers("id", f.id);
  return f;
}

GrainTable grains_of(const PointSource& source, const std::string& path, const std::vector<FieldMapping>& mapping) {
  const Columns columns(source, path, mapping);
  GrainTable g;
  g.position = columns.positions();
  columns.read("diameter", g.diameter);
  if (g.diameter.empty() && columns.has("radius")) {
    columns.read("radius", g.diameter);
    for (float& d : g.diameter) d *= 2.0f;
  }
  columns.read("density", g.density);
  columns.read("velocity", g.velocity);
  columns.read("angular_velocity", g.angular_velocity);
  columns.read_integers("group", g.group);
  columns.read_integers("id", g.id);
  columns.read("porosity", g.porosity);
  return g;
}

BoundaryTable boundary_of(const PointSource& source, const std::string& path) {
  const std::vector<FieldMapping> none;
  const Columns columns(source, path, none);
  BoundaryTable b;
  b.position = columns.positions();
  columns.read("normal", b.normal);
  columns.read("depth", b.depth);
  columns.read("friction", b.friction);
  columns.read_integers("body", b.body);
  columns.read("velocity", b.velocity);
  columns.read("pressure", b.pressure);
  return b;
}

TriangleTable triangles_of(const PointSource& source, const std::string& path) {
  TriangleTable t = source.triangles();
  for (std::size_t i = 0; i < t.vertex.size(); ++i)
    if (!std::isfinite(t.vertex[i].x + t.vertex[i].y + t.vertex[i].z))
      throw Error(ErrorKind::input, path + ": vertex " + std::to_string(i) + " is not finite");
  return t;
}

FrameMeta meta_of(const PointSource& source) {
  FrameMeta meta;
  for (const char* name : {"time", "TimeValue", "TIME", "Time"}) {
    const std::vector<double> time = source.field(name);
    if (time.empty() || !std::isfinite(time[0])) continue;
    meta.time = time[0];
    meta.has_time = true;
    break;
  }
  const std::vector<double> dp = source.field("dp"), offset = source.field("offset");
  if (!dp.empty() && std::isfinite(dp[0]) && dp[0] > 0.0) meta.dp = dp[0];
  if (offset.size() == 3 && std::isfinite(offset[0] + offset[1] + offset[2]))
    meta.offset = {offset[0], offset[1], offset[2]};
  return meta;
}

}  // namespace gdesp
