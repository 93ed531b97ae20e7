// SPDX-License-Identifier: GPL-3.0-or-later
// Points and triangles of an inline binary VTP file without compression.
#include "core/error.hpp"
#include "io/point_source.hpp"
#include "io/vtp_text.hpp"

namespace gdesp {
namespace {

class PlainVtp : public PointSource {
 public:
  explicit PlainVtp(const std::string& path) : text_(path) {
    const VtpArrayText* points = points_array();
    if (!points && text_.points > 0) text_.damaged("it holds no Points array");
    if (points && points->components != 3) text_.damaged("Points have not three components");
  }

  std::size_t size() const override { return text_.points; }

  std::vector<Vec3d> positions() const override {
    static_assert(sizeof(Vec3d) == 3 * sizeof(double));
    const VtpArrayText* points = points_array();
    if (!points) return {};
    if (text_.count(*points) != 3 * text_.points)
      text_.damaged("Points holds " + std::to_string(text_.count(*points) / 3) + " points, expected " +
                    std::to_string(text_.points));
    std::vector<Vec3d> out(text_.points);
    text_.read(*points, 3 * out.size(), reinterpret_cast<double*>(out.data()));
    return out;
  }

  std::vector<std::string> names() const override {
    std::vector<std::string> out;
    for (const VtpArrayText& a : text_.arrays)
      if (a.section == "PointData") out.push_back(a.name);
    return out;
  }
  int components(const std::string& name) const override {
    const VtpArrayText* a = text_.find("PointData", name);
    return a ? a->components : 0;
  }
  void read(const std::string& name, float* values) const override { copy(name, values); }
  void read(const std::string& name, std::int64_t* values) const override { copy(name, values); }
  std::vector<double> field(const std::string& name) const override {
    const VtpArrayText* a = text_.find("FieldData", name);
    return a ? text_.read<double>(*a) : std::vector<double>{};
  }

  TriangleTable triangles() const override {
    TriangleTable table;
    table.vertex = positions();
    const VtpArrayText *corners = text_.find("Polys", "connectivity"), *ends = text_.find("Polys", "offsets");
    if (text_.triangles == 0) return table;
    if (!corners || !ends) text_.damaged("it holds no polygons though it says so");
    const std::vector<std::int64_t> corner = text_.read<std::int64_t>(*corners);
    const std::vector<std::int64_t> end = text_.read<std::int64_t>(*ends);
    const VtpArrayText *body = text_.find("CellData", "body"), *smooth = text_.find("CellData", "smooth");
    const std::vector<std::int32_t> of = body ? text_.read<std::int32_t>(*body) : std::vector<std::int32_t>();
    const std::vector<std::int32_t> slides = smooth ? text_.read<std::int32_t>(*smooth) : std::vector<std::int32_t>();
    if (end.size() != text_.triangles || (body && of.size() != text_.triangles) ||
        (smooth && slides.size() != text_.triangles))
      text_.damaged("it says " + std::to_string(text_.triangles) + " polygons and holds " + std::to_string(end.size()));
    std::int64_t start = 0;
    for (std::size_t i = 0; i < end.size(); ++i) {
      if (end[i] < start || end[i] > std::int64_t(corner.size())) text_.damaged("polygon offsets do not increase");
      for (std::int64_t k = start + 2; k < end[i]; ++k)
        add_triangle(table, corner[std::size_t(start)], corner[std::size_t(k - 1)], corner[std::size_t(k)],
                     of.empty() ? 0 : of[i], slides.empty() ? nullptr : &slides[i]);
      start = end[i];
    }
    return table;
  }

 private:
  const VtpArrayText* points_array() const {
    for (const VtpArrayText& a : text_.arrays)
      if (a.section == "Points") return &a;
    return nullptr;
  }

  template <class T>
  void copy(const std::string& name, T* values) const {
    const VtpArrayText& a = *text_.find("PointData", name);
    text_.read(a, text_.points * std::size_t(a.components), values);
  }

  void add_triangle(TriangleTable& table, std::int64_t a, std::int64_t b, std::int64_t c, std::int32_t body,
                    const std::int32_t* smooth) const {
    const auto count = std::int64_t(table.vertex.size());
    for (const std::int64_t v : {a, b, c})
      if (v < 0 || v >= count)
        text_.damaged("a polygon names vertex " + std::to_string(v) + " of " + std::to_string(count));
    table.triangle.push_back({std::int32_t(a), std::int32_t(b), std::int32_t(c)});
    table.body.push_back(body);
    if (smooth) table.smooth.push_back(*smooth);
  }

  VtpText text_;
};

}  // namespace

std::unique_ptr<PointSource> open_plain_vtp(const std::string& path) {
  try {
    return std::make_unique<PlainVtp>(path);
  } catch (const OtherVtpFlavour&) { return nullptr; }
}

}  // namespace gdesp
