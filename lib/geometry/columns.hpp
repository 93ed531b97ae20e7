// SPDX-License-Identifier: GPL-3.0-or-later
// Vertical columns through a scene: where they enter and leave solids. The inside test of every lattice fill.
//
// Crossings are exact and free of slits: vertices are snapped to a fixed-point grid (extent / 2^30), the side of an
// edge is an integer determinant, and a column that hits an edge or vertex exactly is moved symbolically by
// (e, e^2), as in simulation of simplicity (Edelsbrunner and Muecke 1990, doi:10.1145/77635.77639). A column
// therefore crosses a closed mesh an even number of times, always.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/triangle_mesh.hpp"

namespace gdesp::geometry {

/// nx x ny columns; column (i, j) stands at (x0 + i * spacing, y0 + j * spacing).
struct ColumnGrid {
  double x0 = 0.0, y0 = 0.0, spacing = 1.0;
  int nx = 0, ny = 0;
  std::size_t count() const { return static_cast<std::size_t>(nx) * ny; }
  std::size_t index(int i, int j) const { return static_cast<std::size_t>(j) * nx + i; }
  double x(int i) const { return x0 + i * spacing; }
  double y(int j) const { return y0 + j * spacing; }
};

/// A surface point on a column. `sign` is +1 where an upward ray enters the solid, -1 where it leaves.
struct Crossing {
  double z;
  std::int32_t triangle;
  std::int8_t sign;
};

/// Crossings of all columns, sorted upward within each: those of column c are [first[c], first[c + 1]).
struct Crossings {
  std::vector<std::size_t> first;
  std::vector<Crossing> hit;
};

struct Interval {
  double lower, upper;
};  ///< m

/// Sorted, disjoint intervals of each column.
struct ColumnIntervals {
  std::vector<std::size_t> first;
  std::vector<Interval> interval;
  /// Whether z lies inside one of the column's intervals (lower <= z < upper).
  bool contains(std::size_t column, double z) const;
};

/// All crossings of the mesh with the columns.
Crossings cross_columns(const TriangleMesh& mesh, const ColumnGrid& grid);

/// Inside a closed, outward mesh: where the winding number along the column is positive, so overlapping shells
/// are united and doubled facets do no harm.
ColumnIntervals solid_intervals(const TriangleMesh& mesh, const ColumnGrid& grid);

/// Height of an open sheet at each column: its highest crossing; NaN where the sheet has no triangle.
/// `folded`: number of columns with more than one distinct crossing (apart by more than `tolerance`, m); `where`: the place of one.
std::vector<double> sheet_heights(const TriangleMesh& mesh, const ColumnGrid& grid, double tolerance,
                                  std::size_t* folded, Vec3d* where = nullptr);

/// Union, per column.
ColumnIntervals unite(const ColumnIntervals& a, const ColumnIntervals& b);
/// a minus b, per column.
ColumnIntervals subtract(const ColumnIntervals& a, const ColumnIntervals& b);
/// Sum of interval lengths times the column's area (m3).
double volume(const ColumnIntervals& a, const ColumnGrid& grid);

/// Signed crossings above each point: the winding number of a closed, outward mesh around it (> 0: inside), and for an
/// up-looking sheet 1 where the point lies below it. Same exactness as the columns.
std::vector<int> windings(const TriangleMesh& mesh, const std::vector<Vec3d>& points);

/// Columns that cover `box` horizontally, at spacing `spacing`, centred in their cells.
ColumnGrid covering_columns(const Box& box, double spacing);

}  // namespace gdesp::geometry
