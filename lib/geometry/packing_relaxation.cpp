// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/packing_relaxation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace gdesp::geometry {
namespace {

constexpr double tolerance = 1e-4;        // of the diameter: overlaps below this count as none
constexpr double inflation = 1.003;       // grains are moved apart as if they were this much larger
constexpr double step = 0.25;             // share of the summed overlap added to the displacement in one iteration
constexpr double memory = 0.96;           // of the last displacement
constexpr double wall_weight = 1.5;
constexpr double longest_step = 0.1;      // of the diameter, in one iteration
constexpr int most_iterations = 6000;
constexpr int review = 150;               // iterations between looks at the progress
constexpr double slow = 0.8;              // the sum of overlaps must fall below this share between two looks, else grains go
constexpr std::size_t worth_threads = 4000;   // grains; fewer are moved by one thread

/// Pairs and walls within reach, kept while nothing has moved by half the skin.
class Vicinity {
 public:
  Vicinity(const PackingState& s, const TriangleTree& walls, double largest) : walls_(&walls), cell_(1.3 * inflation * largest) {
    build_pairs(s);
    build_walls(s);
    reference_ = s.position;
  }
  bool is_stale(const PackingState& s, double limit) const {
    bool stale = false;
#pragma omp parallel for reduction(|| : stale) if (s.position.size() > worth_threads)
    for (std::size_t i = 0; i < s.position.size(); ++i) {
      const Vec3d d = s.position[i] - reference_[i];
      stale = stale || dot(d, d) > limit * limit;
    }
    return stale;
  }

  std::vector<std::size_t> first, first_wall;
  std::vector<std::uint32_t> other;
  std::vector<std::int32_t> wall;

 private:
  struct Cell { std::int32_t x, y, z; };
  Cell cell_of(const Vec3d& p) const {
    return {static_cast<std::int32_t>(std::floor(p.x / cell_)), static_cast<std::int32_t>(std::floor(p.y / cell_)),
            static_cast<std::int32_t>(std::floor(p.z / cell_))};
  }
  static std::size_t hash(const Cell& c) {
    return (static_cast<std::uint32_t>(c.x) * 73856093u) ^ (static_cast<std::uint32_t>(c.y) * 19349663u) ^
           (static_cast<std::uint32_t>(c.z) * 83492791u);
  }

  void build_pairs(const PackingState& s) {
    const std::size_t n = s.position.size();
    std::size_t buckets = 1;
    while (buckets < n) buckets *= 2;
    std::vector<std::size_t> start(buckets + 1, 0);
    std::vector<std::uint32_t> member(n);
    for (std::size_t i = 0; i < n; ++i) ++start[(hash(cell_of(s.position[i])) & (buckets - 1)) + 1];
    for (std::size_t b = 0; b < buckets; ++b) start[b + 1] += start[b];
    std::vector<std::size_t> next(start.begin(), start.end() - 1);
    for (std::size_t i = 0; i < n; ++i) member[next[hash(cell_of(s.position[i])) & (buckets - 1)]++] = static_cast<std::uint32_t>(i);
    const auto visit = [&](std::size_t i, auto&& use) {
      const Cell c = cell_of(s.position[i]);
      for (int dx = -1; dx <= 1; ++dx) {
        for (int dy = -1; dy <= 1; ++dy) {
          for (int dz = -1; dz <= 1; ++dz) {
            const Cell k{c.x + dx, c.y + dy, c.z + dz};
            const std::size_t b = hash(k) & (buckets - 1);
            for (std::size_t m = start[b]; m < start[b + 1]; ++m) {
              const std::uint32_t j = member[m];
              const Cell own = cell_of(s.position[j]);
              if (j == i || own.x != k.x || own.y != k.y || own.z != k.z) continue;
              const Vec3d d = s.position[i] - s.position[j];
              const double reach = 0.5 * inflation * (s.diameter[i] + s.diameter[j]) + skin();
              if (dot(d, d) < reach * reach) use(j);
            }
          }
        }
      }
    };
    first.assign(n + 1, 0);
#pragma omp parallel for schedule(static, 1024) if (n > worth_threads)
    for (std::size_t i = 0; i < n; ++i) visit(i, [&](std::uint32_t) { ++first[i + 1]; });
    for (std::size_t i = 0; i < n; ++i) first[i + 1] += first[i];
    other.resize(first[n]);
#pragma omp parallel for schedule(static, 1024) if (n > worth_threads)
    for (std::size_t i = 0; i < n; ++i) {
      std::size_t at = first[i];
      visit(i, [&](std::uint32_t j) { other[at++] = j; });
    }
  }

  void build_walls(const PackingState& s) {
    const std::size_t n = s.position.size();
    std::vector<std::vector<std::int32_t>> near(n);
#pragma omp parallel for schedule(static, 256) if (n > worth_threads)
    for (std::size_t i = 0; i < n; ++i) walls_->within(s.position[i], 0.5 * inflation * s.diameter[i] + skin(), near[i]);
    first_wall.assign(n + 1, 0);
    for (std::size_t i = 0; i < n; ++i) first_wall[i + 1] = first_wall[i] + near[i].size();
    wall.reserve(first_wall[n]);
    for (const auto& list : near) wall.insert(wall.end(), list.begin(), list.end());
  }

 public:
  double skin() const { return 0.2 * cell_ / 1.3; }

 private:
  const TriangleTree* walls_;
  double cell_;
  std::vector<Vec3d> reference_;
};

/// How far, and in which direction, a grain sticks into a triangle; the side is told by the triangle's normal where the
/// nearest point lies inside it.
Vec3d wall_push(const Vec3d& p, double radius, const TriangleTree& walls, std::int32_t t) {
  int feature = 0;
  const Vec3d* c = walls.corners(t);
  const Vec3d away = p - closest_point(p, c[0], c[1], c[2], &feature);
  const double distance = norm(away);
  if (distance >= radius) return {};
  const Vec3d n = walls.normal(t);
  if (feature == 0) {
    const double signed_distance = dot(away, n) < 0.0 ? -distance : distance;
    return n * (radius - signed_distance);
  }
  return distance > 0.0 ? away * ((radius - distance) / distance) : n * radius;
}

struct Push { Vec3d sum; double worst = 0.0; };   // worst: largest true overlap, of the smaller diameter

Push push_on(std::size_t i, const PackingState& s, const Vicinity& v, const TriangleTree& walls) {
  Push out;
  for (std::size_t k = v.first[i]; k < v.first[i + 1]; ++k) {
    const std::uint32_t j = v.other[k];
    const Vec3d r = s.position[i] - s.position[j];
    const double sum = 0.5 * (static_cast<double>(s.diameter[i]) + s.diameter[j]), d2 = dot(r, r);
    if (d2 >= inflation * inflation * sum * sum) continue;
    const double d = std::sqrt(d2);
    out.worst = std::max(out.worst, (sum - d) / std::min(s.diameter[i], s.diameter[j]));
    const Vec3d n = d > 1e-12 * sum ? r * (1.0 / d) : Vec3d{i < j ? 1.0 : -1.0, 0.0, 0.0};
    out.sum += n * (inflation * sum - d);
  }
  const double radius = 0.5 * s.diameter[i];
  for (std::size_t k = v.first_wall[i]; k < v.first_wall[i + 1]; ++k) {
    const Vec3d push = wall_push(s.position[i], inflation * radius, walls, v.wall[k]);
    const double depth = norm(push);
    if (depth == 0.0) continue;
    out.worst = std::max(out.worst, (depth - (inflation - 1.0) * radius) / s.diameter[i]);
    out.sum += push * wall_weight;
  }
  return out;
}

void keep(PackingState& s, const std::vector<bool>& wanted) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < s.position.size(); ++i) {
    if (!wanted[i]) continue;
    s.position[n] = s.position[i];
    s.diameter[n] = s.diameter[i];
    ++n;
  }
  s.position.resize(n);
  s.diameter.resize(n);
}

/// Takes out the grains with the worst overlaps: a quarter of those that overlap, at most one in fifty of all.
void take_out_tightest(PackingState& s, const std::vector<double>& worst) {
  std::vector<std::size_t> tight;
  for (std::size_t i = 0; i < worst.size(); ++i) {
    if (worst[i] > tolerance) tight.push_back(i);
  }
  std::sort(tight.begin(), tight.end(), [&](std::size_t a, std::size_t b) { return worst[a] != worst[b] ? worst[a] > worst[b] : a < b; });
  tight.resize(std::min((tight.size() + 3) / 4, s.position.size() / 50 + 1));
  std::vector<bool> wanted(s.position.size(), true);
  for (const std::size_t i : tight) wanted[i] = false;
  keep(s, wanted);
}

}  // namespace

int relax_overlaps(PackingState& s, const TriangleTree& walls, double largest) {
  std::vector<Vec3d> motion(s.position.size());
  std::vector<double> worst(s.position.size());
  std::vector<Push> push(s.position.size());
  Vicinity vicinity(s, walls, largest);
  double last_sum = 1e300;
  int iteration = 0;
  for (; iteration < most_iterations && !s.position.empty(); ++iteration) {
    const std::size_t n = s.position.size();
    double largest_now = 0.0;
#pragma omp parallel for schedule(static, 1024) reduction(max : largest_now) if (n > worth_threads)
    for (std::size_t i = 0; i < n; ++i) {
      push[i] = push_on(i, s, vicinity, walls);
      worst[i] = push[i].worst;
      largest_now = std::max(largest_now, push[i].worst);
    }
    if (largest_now < tolerance) break;
    if (iteration % review == review - 1) {
      const double sum = std::accumulate(worst.begin(), worst.end(), 0.0);
      const bool stalled = sum > slow * last_sum;
      last_sum = sum;
      if (stalled) {
        take_out_tightest(s, worst);
        motion.assign(s.position.size(), {});
        worst.resize(s.position.size());
        push.resize(s.position.size());
        vicinity = Vicinity(s, walls, largest);
        continue;
      }
    }
#pragma omp parallel for schedule(static, 1024) if (n > worth_threads)
    for (std::size_t i = 0; i < n; ++i) {
      Vec3d m = motion[i] * memory;
      if (dot(m, push[i].sum) < 0.0) m = m * 0.5;
      m += push[i].sum * step;
      const double length = norm(m), limit = longest_step * s.diameter[i];
      motion[i] = length > limit ? m * (limit / length) : m;
      if (s.dimensions == 2) motion[i].y = 0.0;
      s.position[i] += motion[i];
    }
    if (vicinity.is_stale(s, 0.5 * vicinity.skin())) vicinity = Vicinity(s, walls, largest);
  }
  return iteration;
}

void drop_misplaced(PackingState& s, const TriangleTree& walls,
                    const std::function<std::vector<bool>(const std::vector<Vec3d>&)>& contains, double largest) {
  std::vector<bool> wanted = contains(s.position);
  keep(s, wanted);
  const Vicinity vicinity(s, walls, largest);
  wanted.assign(s.position.size(), true);
  for (std::size_t i = 0; i < s.position.size(); ++i) {
    const double radius = 0.5 * s.diameter[i];
    for (std::size_t k = vicinity.first_wall[i]; k < vicinity.first_wall[i + 1]; ++k) {
      const Vec3d* c = walls.corners(vicinity.wall[k]);
      const double distance = norm(s.position[i] - closest_point(s.position[i], c[0], c[1], c[2]));
      if (radius - distance > 1e-3 * s.diameter[i]) wanted[i] = false;
    }
  }
  keep(s, wanted);
}

double largest_overlap(const PackingState& s, const TriangleTree& walls, double largest) {
  if (s.position.empty()) return 0.0;
  const Vicinity vicinity(s, walls, largest);
  double worst = 0.0;
#pragma omp parallel for schedule(static, 1024) reduction(max : worst)
  for (std::size_t i = 0; i < s.position.size(); ++i) worst = std::max(worst, push_on(i, s, vicinity, walls).worst);
  return std::max(worst, 0.0);
}

}  // namespace gdesp::geometry
