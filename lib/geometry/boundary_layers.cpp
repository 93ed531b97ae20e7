// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/boundary_layers.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "geometry/symmetry_planes.hpp"

namespace gdesp::geometry {
namespace {

void add(BoundaryTable& out, const Vec3d& p, const Vec3d& normal, double depth, std::int32_t body, bool no_slip) {
  out.position.push_back(p);
  out.normal.push_back(static_cast<Vec3f>(normal));
  out.depth.push_back(static_cast<float>(depth));
  out.body.push_back(body);
  out.friction.push_back(no_slip ? 1.0f : 0.0f);
}

/// Coordinates along one axis of a tank: layers before its lower face, points fitted between, layers after its upper face.
std::vector<double> tank_ticks(int axis, const WallPart& tank, const Lattice& lattice, bool low_closed,
                               bool high_closed) {
  std::vector<double> ticks;
  const double lo = tank.tank.lower[axis], hi = tank.tank.upper[axis], dp = lattice.dp;
  if (lattice.dimensions == 2 && axis == 1) return {0.0};
  for (int k = boundary_layer_count - 1; k >= 0 && low_closed; --k) ticks.push_back(lo - (k + 0.5) * dp);
  const int n = std::max(1, static_cast<int>(std::lround((hi - lo) / dp)));
  for (int i = 0; i < n; ++i) ticks.push_back(lo + (i + 0.5) * (hi - lo) / n);
  for (int k = 0; k < boundary_layer_count && high_closed; ++k) ticks.push_back(hi + (k + 0.5) * dp);
  return ticks;
}

bool inside_other_tank(const SceneParts& parts, const WallPart* own, const Vec3d& p) {
  for (const auto& w : parts.walls) {
    if (w.kind != WallPart::Kind::tank || &w == own) continue;
    bool inside = true;
    for (int a = 0; a < 3; ++a) inside = inside && p[a] > w.tank.lower[a] && p[a] < w.tank.upper[a];
    if (inside) return true;
  }
  return false;
}

void add_one_tank(const WallPart& tank, const SceneParts& parts, const Lattice& lattice, BoundaryTable& out) {
  std::vector<double> ticks[3];
  for (int a = 0; a < 3; ++a)
    ticks[a] = tank_ticks(a, tank, lattice, !is_open(tank, tank_face[2 * a]), !is_open(tank, tank_face[2 * a + 1]));
  const Vec3d lo = tank.tank.lower, hi = tank.tank.upper;
  for (const double x : ticks[0]) {
    for (const double y : ticks[1]) {
      for (const double z : ticks[2]) {
        const Vec3d p{x, y, z + lattice.shift_at(z)};
        Vec3d inward;
        bool no_slip = false;  // what stands behind planes of symmetry alone lets the fluid slip
        for (int a = 0; a < 3; ++a) {
          inward[a] = p[a] < lo[a] ? lo[a] - p[a] : (p[a] > hi[a] ? hi[a] - p[a] : 0.0);
          no_slip = no_slip || (tank.no_slip && inward[a] != 0.0 &&
                                !is_symmetry(tank, tank_face[2 * a + (inward[a] > 0.0 ? 0 : 1)]));
        }
        const double depth = norm(inward);
        if (depth == 0.0 || inside_other_tank(parts, &tank, p)) continue;
        add(out, p, inward * (1.0 / depth), depth, 0, no_slip);
      }
    }
  }
}

/// Inside a tank's wall: where its own layers stand.
bool in_tank_wall(const SceneParts& parts, const Vec3d& p, double dp) {
  bool any = false;
  for (const auto& w : parts.walls) {
    if (w.kind != WallPart::Kind::tank) continue;
    if (tank_clearance(w, p) > -1e-6 * dp) return false;
    any = true;
  }
  return any;
}

bool belongs_to_tank(const BandPoint& b, const SceneParts& parts, const Lattice& lattice) {
  const bool face =
      b.material >= 2 && parts.walls[static_cast<std::size_t>(b.material) - 2].kind == WallPart::Kind::tank;
  return face || in_tank_wall(parts, lattice.point(b.at), lattice.dp);
}

bool is_no_slip(const SceneParts& parts, std::int32_t material) {
  return material >= 2 ? parts.walls[static_cast<std::size_t>(material) - 2].no_slip : parts.terrain_no_slip;
}

void add_box_body(const SolidPart& body, std::int32_t number, const Lattice& lattice, const bool (&endless)[3],
                  BoundaryTable& out) {
  const Box& box = *body.box;
  int n[3];
  Vec3d step;
  for (int a = 0; a < 3; ++a) {
    const double length = box.upper[a] - box.lower[a];
    const bool flat = lattice.dimensions == 2 && a == 1;
    n[a] = flat ? 1 : std::max(1, static_cast<int>(std::lround(length / lattice.dp)));
    step[a] = length / n[a];
  }
  const double deepest = boundary_layer_count * lattice.dp;
  for (int i = 0; i < n[0]; ++i) {
    for (int j = 0; j < n[1]; ++j) {
      for (int k = 0; k < n[2]; ++k) {
        Vec3d p = box.lower + Vec3d{(i + 0.5) * step.x, (j + 0.5) * step.y, (k + 0.5) * step.z};
        if (lattice.dimensions == 2) p.y = 0.0;
        double depth = 1e300;
        Vec3d normal;
        for (int a = 0; a < 3; ++a) {
          if (endless[a] || (lattice.dimensions == 2 && a == 1)) continue;
          for (int side = -1; side <= 1; side += 2) {
            const double d = side < 0 ? p[a] - box.lower[a] : box.upper[a] - p[a];
            if (d >= depth - 1e-12 * lattice.dp) continue;
            depth = d;
            normal = {};
            normal[a] = side;
          }
        }
        if (depth <= deepest) add(out, p, normal, depth, number, body.no_slip);
      }
    }
  }
}

}  // namespace

void add_tank_layers(const SceneParts& parts, const Lattice& lattice, BoundaryTable& out) {
  for (const auto& w : parts.walls) {
    if (w.kind == WallPart::Kind::tank) add_one_tank(w, parts, lattice, out);
  }
}

void add_band_layers(const std::vector<BandPoint>& band, const SceneParts& parts, const Lattice& lattice,
                     BoundaryTable& out) {
  for (const auto& b : band) {
    if (b.distance > 0.0f || -b.distance > boundary_layer_count * lattice.dp || belongs_to_tank(b, parts, lattice))
      continue;
    add(out, lattice.place(b.at), static_cast<Vec3d>(b.normal), placed_depth(b, lattice), 0,
        is_no_slip(parts, b.material));
  }
}

void add_fitted_layers(const std::vector<BandPoint>& band, const SceneParts& parts, LayerRequest request,
                       BoundaryTable& out) {
  std::vector<BandPoint> own;
  std::copy_if(band.begin(), band.end(), std::back_inserter(own),
               [&](const BandPoint& b) { return !belongs_to_tank(b, parts, request.lattice); });
  request.others = out.position;
  for (const auto& p : fit_layers(own, request))
    add(out, p.position, p.normal, p.depth, 0, is_no_slip(parts, p.material));
}

void add_body_layers(const SolidPart& body, std::int32_t number, const Lattice& lattice, const bool (&endless)[3],
                     BoundaryTable& out) {
  if (body.box) return add_box_body(body, number, lattice, endless, out);
  Box box = bounds(body.mesh);
  const LatticeColumns columns = lattice_columns(lattice, box);
  const ColumnIntervals solid = solid_intervals(body.mesh, columns.grid);
  WallSurfaces surface{body.mesh, std::vector<std::int32_t>(body.mesh.triangle.size(), number)};
  BandRequest request;
  request.lattice = lattice;
  request.columns = columns;
  request.solid = &solid;
  for (int a = 0; a < 3; ++a) {
    request.lower[a] = lattice.dimensions == 2 && a == 1 ? 0 : lattice.first_at_or_above(a, box.lower[a]);
    request.upper[a] = lattice.dimensions == 2 && a == 1 ? 0 : lattice.last_at_or_below(a, box.upper[a]);
  }
  request.half_width = boundary_layer_count;
  std::size_t added = 0;
  for (const auto& b : signed_distance_band(surface, request, "", {})) {
    if (b.distance > 0.0f) continue;
    add(out, lattice.place(b.at), static_cast<Vec3d>(b.normal), placed_depth(b, lattice), number, body.no_slip);
    ++added;
  }
  if (added == 0)
    throw Error(ErrorKind::input, body.name + " is thinner than resolution.dp = " + std::to_string(lattice.dp) +
                                      " m: no particle fits; refine dp");
}

TriangleMesh tank_faces(const WallPart& tank) {
  TriangleMesh box = box_mesh(tank.tank), out;  // box_mesh lists its faces in the same order, two triangles each
  flip(box);
  out.vertex = box.vertex;
  for (int f = 0; f < 6; ++f) {
    if (is_open(tank, tank_face[f])) continue;
    out.triangle.push_back(box.triangle[2 * f]);
    out.triangle.push_back(box.triangle[2 * f + 1]);
  }
  return out;
}

}  // namespace gdesp::geometry
