// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/fitted_layers.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/point_cells.hpp"
#include "geometry/triangle_tree.hpp"

namespace gdesp::geometry {
namespace {

// All lengths in dp.
constexpr double reach = 2.0;        // of the repulsion within a layer
constexpr double fixed_reach = 1.0;  // of the repulsion by particles that stay
constexpr double skin = 0.6;         // of the lists of neighbours, which last for a few steps
constexpr int renewal = 5;
constexpr double pace = 0.4;  // of a step over the sum of repulsions
constexpr double longest_step = 0.15;
constexpr double still = 0.001;  // mean step at which the layers count as even
constexpr int most_steps = 60;
constexpr double leash = 1.0;     // from where a particle was born: a layer that ends does not spread past its end
constexpr double look = 0.25;     // way after which the surface is looked at again
constexpr double farthest = 5.0;  // from the surface
constexpr double misfit = 0.25;   // largest error of a depth at which a particle still belongs to its layer

class Layers {
 public:
  explicit Layers(const LayerRequest& r)
      : r_(r), dp_(r.lattice.dp), flat_(r.lattice.dimensions == 2), tree_(*r.surface) {}

  std::vector<LayerPoint> fit(const std::vector<BandPoint>& band) {
    seed(band, kept_on_lattice(band));
    step_.resize(point_.size());
    for (int k = 0; k < most_steps; ++k) {
      if (k % renewal == 0) renew();
      if (relax() < still) break;
    }
#pragma omp parallel for schedule(dynamic, 256)
    for (std::size_t i = 0; i < point_.size(); ++i) {
      if (layer_[i] >= 0) bring_back(i);
    }
    return std::move(point_);
  }

 private:
  struct Foot {
    double depth;
    Vec3d normal;
  };  // m; unit, towards the surface

  double depth_of(int layer) const { return (layer + 0.5) * dp_; }

  Foot foot(const Vec3d& p) const {
    const NearestPoint near = tree_.nearest(p, farthest * dp_);
    Vec3d away = near.point - p;
    if (flat_) away.y = 0.0;
    return {near.distance, away * (1.0 / std::max(near.distance, 1e-300))};
  }

  /// The way of a lattice point to a layer, along its normal; false where the depth does not change as it should.
  bool enter(const BandPoint& b, int layer, LayerPoint& out) const {
    const Vec3d normal = static_cast<Vec3d>(b.normal);
    out = {r_.lattice.point(b.at) + normal * (-b.distance - depth_of(layer)), normal, depth_of(layer), b.material};
    for (int k = 0; k < 3; ++k) {
      const Foot f = foot(out.position);
      const double error = f.depth - out.depth;
      if (std::abs(error) > misfit * dp_ || dot(f.normal, normal) < 0.0) return false;
      out.position += f.normal * error;
      out.normal = f.normal;
    }
    return inside(out.position);
  }

  /// Band points beside water that asks for it, and such inside walls that cannot enter their layer.
  std::vector<std::uint8_t> kept_on_lattice(const std::vector<BandPoint>& band) const {
    std::vector<std::uint8_t> kept(band.size());
    const PointCells wet(r_.wet, r_.wet_reach > 0.0 ? r_.wet_reach : dp_);
#pragma omp parallel for schedule(dynamic, 256)
    for (std::size_t i = 0; i < band.size(); ++i) {
      bool keep = wet.any_within(r_.lattice.point(band[i].at), r_.wet_reach);
      LayerPoint p;
      if (!keep && is_in_layers(band[i])) keep = !enter(band[i], static_cast<int>(-band[i].distance / dp_), p);
      kept[i] = keep;
    }
    return kept;
  }

  bool is_in_layers(const BandPoint& b) const { return b.distance < 0.0f && -b.distance < boundary_layer_count * dp_; }

  void seed(const std::vector<BandPoint>& band, const std::vector<std::uint8_t>& kept) {
    double volume[boundary_layer_count] = {};
    for (std::size_t i = 0; i < band.size(); ++i) {
      const Vec3d normal = static_cast<Vec3d>(band[i].normal);
      const double depth = -band[i].distance;
      if (kept[i]) {
        if (is_in_layers(band[i]))
          add({r_.lattice.place(band[i].at), normal, placed_depth(band[i], r_.lattice), band[i].material}, -1);
        continue;
      }
      for (int k = 0; k < boundary_layer_count; ++k) {
        volume[k] += cube_below_plane(normal, depth / dp_ - k) - cube_below_plane(normal, depth / dp_ - k - 1);
        LayerPoint p;
        if (volume[k] < 0.5 || !enter(band[i], k, p)) continue;
        volume[k] -= 1.0;
        add(p, k);
      }
    }
  }

  void add(const LayerPoint& p, int layer) {
    point_.push_back(p);
    layer_.push_back(layer);
    born_.push_back(p.position);
    looked_.push_back(p.position);
  }

  bool inside(const Vec3d& p) const {
    for (int a = 0; a < 3; ++a) {
      if (!(flat_ && a == 1) && (p[a] < r_.domain.lower[a] || p[a] > r_.domain.upper[a])) return false;
    }
    return true;
  }

  void renew() {
    all_.clear();
    for (const auto& p : point_) all_.push_back(p.position);
    all_.insert(all_.end(), r_.others.begin(), r_.others.end());
    const double width = (reach + skin) * dp_;
    const PointCells cells(all_, width);
    neighbour_.resize(point_.size());
#pragma omp parallel for schedule(dynamic, 256)
    for (std::size_t i = 0; i < point_.size(); ++i) {
      neighbour_[i].clear();
      if (layer_[i] < 0) continue;
      cells.near(point_[i].position, width, [&](std::uint32_t j, double) {
        if (j != i && (stays(j) || layer_[j] == layer_[i])) neighbour_[i].push_back(j);
      });
    }
  }

  bool stays(std::uint32_t j) const { return j >= layer_.size() || layer_[j] < 0; }

  /// One step of all; returns their mean (root of the mean square), in dp.
  double relax() {
#pragma omp parallel for schedule(static)
    for (std::size_t i = 0; i < point_.size(); ++i) step_[i] = layer_[i] < 0 ? Vec3d{} : drive(i);
#pragma omp parallel for schedule(dynamic, 256)
    for (std::size_t i = 0; i < point_.size(); ++i) {
      if (layer_[i] >= 0) advance(i);
    }
    double sum = 0.0;
    for (const Vec3d& s : step_) sum += dot(s, s);
    return std::sqrt(sum / static_cast<double>(step_.size() + 1));
  }

  /// Step along the layer, in dp.
  Vec3d drive(std::size_t i) const {
    Vec3d sum;
    for (const std::uint32_t j : neighbour_[i]) {
      const Vec3d r = (point_[i].position - (j < point_.size() ? point_[j].position : all_[j])) * (1.0 / dp_);
      const double distance = norm(r), t = 1.0 - distance / (stays(j) ? fixed_reach : reach);
      if (t <= 0.0) continue;
      sum += distance > 1e-6 ? r * (t * t / distance) : Vec3d{i < j ? 1.0 : -1.0, 0.0, 0.0};
    }
    sum -= point_[i].normal * dot(sum, point_[i].normal);
    if (flat_) sum.y = 0.0;
    sum *= pace;
    const double length = norm(sum);
    return length > longest_step ? sum * (longest_step / length) : sum;
  }

  /// The surface is looked at again only after a while: it is flat for a step or two.
  void advance(std::size_t i) {
    const Vec3d from = point_[i].position;
    point_[i].position += step_[i] * dp_;
    if (!inside(point_[i].position) || norm(point_[i].position - born_[i]) > leash * dp_) point_[i].position = from;
    if (norm(point_[i].position - looked_[i]) > look * dp_) bring_back(i);
  }

  /// To its depth; where that is over an edge, to where it was last time.
  void bring_back(std::size_t i) {
    LayerPoint& p = point_[i];
    const Foot f = foot(p.position);
    const double error = f.depth - p.depth;
    if (std::abs(error) > misfit * dp_ || dot(f.normal, p.normal) < 0.0) {
      p.position = looked_[i];
      return;
    }
    p.position += f.normal * error;
    p.normal = f.normal;
    looked_[i] = p.position;
  }

  const LayerRequest& r_;
  double dp_;
  bool flat_;
  TriangleTree tree_;
  std::vector<LayerPoint> point_;
  std::vector<int> layer_;  // -1: stays on the lattice
  std::vector<Vec3d> born_, looked_, step_, all_;
  std::vector<std::vector<std::uint32_t>> neighbour_;  // of the same layer, or such as stay
};

}  // namespace

double cube_below_plane(const Vec3d& n, double level) {
  double m[3], sum = 0.0;
  for (int a = 0; a < 3; ++a) m[a] = std::max(std::abs(n[a]), 1e-3), sum += m[a];
  const double s = level + 0.5 * sum;  // from the corner that lies lowest
  if (s <= 0.0) return 0.0;
  if (s >= sum) return 1.0;
  const auto cube = [](double x) { return x > 0.0 ? x * x * x : 0.0; };
  double v = cube(s);
  for (int a = 0; a < 3; ++a) v += cube(s - sum + m[a]) - cube(s - m[a]);
  return v / (6.0 * m[0] * m[1] * m[2]);
}

std::vector<LayerPoint> fit_layers(const std::vector<BandPoint>& band, const LayerRequest& request) {
  return Layers(request).fit(band);
}

}  // namespace gdesp::geometry
