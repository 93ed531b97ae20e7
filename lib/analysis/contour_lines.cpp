// SPDX-License-Identifier: GPL-3.0-or-later
// Marching squares (Lorensen & Cline 1987 in two dimensions), saddle points resolved by the mean of the four corners.
#include <cmath>
#include <map>

#include "analysis/map_measurement.hpp"

namespace gdesp::analysis {
namespace {

using EdgeKey = std::int64_t;  // 2 * node + (0: edge to the right, 1: edge upwards)

class Marcher {
 public:
  Marcher(const Raster& raster, double value) : raster_(raster), value_(value) {}

  std::vector<std::vector<Point2>> trace() {
    for (int iy = 0; iy + 1 < raster_.ny; ++iy) {
      for (int ix = 0; ix + 1 < raster_.nx; ++ix) visit(ix, iy);
    }
    std::vector<std::vector<Point2>> lines;
    while (!next_.empty()) lines.push_back(chain());
    return lines;
  }

 private:
  double at(int ix, int iy) const {
    const double v = raster_.at(ix, iy);
    return std::isfinite(v) ? v : NAN;
  }
  bool above(int ix, int iy) const { return at(ix, iy) > value_; }  // false for NaN

  EdgeKey horizontal(int ix, int iy) const { return 2 * (static_cast<EdgeKey>(iy) * raster_.nx + ix); }
  EdgeKey vertical(int ix, int iy) const { return horizontal(ix, iy) + 1; }

  Point2 point(EdgeKey edge) const {
    const EdgeKey node = edge / 2;
    const int ix = static_cast<int>(node % raster_.nx), iy = static_cast<int>(node / raster_.nx);
    const int jx = edge % 2 ? ix : ix + 1, jy = edge % 2 ? iy + 1 : iy;
    const double a = at(ix, iy), b = at(jx, jy);
    const double u = std::isfinite(a) && std::isfinite(b) && a != b ? (value_ - a) / (b - a) : 0.5;
    return {raster_.x0 + (ix + u * (jx - ix)) * raster_.dx, raster_.y0 + (iy + u * (jy - iy)) * raster_.dx};
  }

  // Segments run with the higher side to their left.
  void segment(EdgeKey from, EdgeKey to) { next_.emplace(from, to), ends_.emplace(to, from); }

  void visit(int ix, int iy) {
    const EdgeKey bottom = horizontal(ix, iy), top = horizontal(ix, iy + 1), left = vertical(ix, iy),
                  right = vertical(ix + 1, iy);
    const int code = above(ix, iy) | above(ix + 1, iy) << 1 | above(ix + 1, iy + 1) << 2 | above(ix, iy + 1) << 3;
    switch (code) {
      case 1:
        segment(bottom, left);
        break;
      case 2:
        segment(right, bottom);
        break;
      case 3:
        segment(right, left);
        break;
      case 4:
        segment(top, right);
        break;
      case 6:
        segment(top, bottom);
        break;
      case 7:
        segment(top, left);
        break;
      case 8:
        segment(left, top);
        break;
      case 9:
        segment(bottom, top);
        break;
      case 11:
        segment(right, top);
        break;
      case 12:
        segment(left, right);
        break;
      case 13:
        segment(bottom, right);
        break;
      case 14:
        segment(left, bottom);
        break;
      case 5:
      case 10:
        saddle(ix, iy, code == 5, bottom, top, left, right);
        break;
      default:
        break;
    }
  }

  void saddle(int ix, int iy, bool five, EdgeKey bottom, EdgeKey top, EdgeKey left, EdgeKey right) {
    const double mean = 0.25 * (at(ix, iy) + at(ix + 1, iy) + at(ix, iy + 1) + at(ix + 1, iy + 1));
    const bool joined = mean > value_;
    if (five && joined) segment(bottom, right), segment(top, left);
    if (five && !joined) segment(bottom, left), segment(top, right);
    if (!five && joined) segment(right, top), segment(left, bottom);
    if (!five && !joined) segment(right, bottom), segment(left, top);
  }

  std::vector<Point2> chain() {
    EdgeKey start = next_.begin()->first;
    for (auto before = ends_.find(start); before != ends_.end(); before = ends_.find(start)) {
      start = before->second;
      if (start == next_.begin()->first) break;  // closed
    }
    std::vector<Point2> line{point(start)};
    for (auto step = next_.find(start); step != next_.end(); step = next_.find(start)) {
      start = step->second;
      ends_.erase(start);
      next_.erase(step);
      line.push_back(point(start));
    }
    return line;
  }

  const Raster& raster_;
  double value_;
  std::map<EdgeKey, EdgeKey> next_, ends_;
};

}  // namespace

std::vector<std::vector<Point2>> contour_lines(const Raster& raster, double value) {
  return Marcher(raster, value).trace();
}

}  // namespace gdesp::analysis
