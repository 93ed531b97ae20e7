// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/packing_relaxation.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "core/triangle.hpp"
#include "geometry/packing_vicinity.hpp"

namespace gdesp::geometry {
namespace {

constexpr double tolerance = packing_overlap;
constexpr double inflation = 1.003;  // grains are moved apart as if they were this much larger
constexpr double step = 0.35;        // share of the summed overlap added to the displacement in one iteration
constexpr double memory = 0.96;      // of the last displacement
constexpr double wall_weight = 1.5;
constexpr double longest_step = 0.1;  // of the diameter, in one iteration
constexpr int most_iterations = 6000;
constexpr int roll_call = 10;   // iterations
constexpr int review = 150;     // iterations between looks at the progress
constexpr double slow = 0.8;    // the sum of overlaps must fall below this share between two looks, else grains go
constexpr double still = 1e-4;  // of the diameter, in one iteration: a free grain slower than this is halted

/// How far, and in which direction, a grain sticks into a triangle; the side is told by the triangle's normal where the
/// nearest point lies inside it.
Vec3d wall_push(const Vec3d& p, double radius, const TriangleTree& walls, std::int32_t t) {
  TriangleFeature feature = TriangleFeature::face;
  const Vec3d* c = walls.corners(t);
  const Vec3d away = p - closest_point(p, c[0], c[1], c[2], &feature);
  const double distance = norm(away);
  if (distance >= radius) return {};
  const Vec3d n = walls.normal(t);
  if (feature == TriangleFeature::face) {
    const double signed_distance = dot(away, n) < 0.0 ? -distance : distance;
    return n * (radius - signed_distance);
  }
  return distance > 0.0 ? away * ((radius - distance) / distance) : n * radius;
}

struct Push {
  Vec3d sum;
  double worst = 0.0;
};  // worst: largest true overlap, of the smaller diameter

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
  if (s.dimensions == 2) out.sum.y = 0.0;
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
  std::sort(tight.begin(), tight.end(),
            [&](std::size_t a, std::size_t b) { return worst[a] != worst[b] ? worst[a] > worst[b] : a < b; });
  tight.resize(std::min((tight.size() + 3) / 4, s.position.size() / 50 + 1));
  std::vector<bool> wanted(s.position.size(), true);
  for (const std::size_t i : tight) wanted[i] = false;
  keep(s, wanted);
}

/// The minimisation. Only grains that move, are pushed or have a neighbour that moved are looked at: the others sleep.
class Relaxation {
 public:
  Relaxation(PackingState& s, const TriangleTree& walls, double largest)
      : s_(s), walls_(walls), vicinity_(walls, largest, inflation) {
    restart();
  }

  int run() {
    double last_sum = 1e300;
    int iteration = 0;
    for (; iteration < most_iterations && !s_.position.empty(); ++iteration) {
      list_awake();
      if (push_awake() < tolerance) break;
      if (iteration % review == review - 1) {
        const double sum = std::accumulate(worst_.begin(), worst_.end(), 0.0);
        const bool stalled = sum > slow * last_sum;
        last_sum = sum;
        if (stalled) {
          take_out_tightest(s_, worst_);
          restart();
          continue;
        }
      }
      move_awake(iteration);
      if (vicinity_.is_stale(s_)) vicinity_.renew(s_);
    }
    return iteration;
  }

 private:
  void restart() {
    const std::size_t n = s_.position.size();
    motion_.assign(n, {});
    push_.assign(n, {});
    worst_.assign(n, 0.0);
    awake_.assign(n, 1);
    vicinity_.renew(s_);
  }

  void list_awake() {
    list_.clear();
    for (std::size_t i = 0; i < awake_.size(); ++i) {
      if (awake_[i]) list_.push_back(static_cast<std::uint32_t>(i));
    }
  }

  /// Returns the largest overlap.
  double push_awake() {
    double largest = 0.0;
#pragma omp parallel for schedule(dynamic, 1024) reduction(max : largest) if (list_.size() > worth_threads)
    for (std::size_t k = 0; k < list_.size(); ++k) {
      const std::uint32_t i = list_[k];
      const Push push = push_on(i, s_, vicinity_, walls_);
      push_[i] = push.sum;
      worst_[i] = push.worst;
      largest = std::max(largest, push.worst);
    }
    return largest;
  }

  /// While most grains are awake, all stay so: to find out who may sleep costs as much as it saves.
  void move_awake(int iteration) {
    const bool all = 2 * list_.size() > awake_.size() && iteration % roll_call != 0;
    std::fill(awake_.begin(), awake_.end(), all ? 1 : 0);
#pragma omp parallel for schedule(dynamic, 1024) if (list_.size() > worth_threads)
    for (std::size_t k = 0; k < list_.size(); ++k) {
      const std::uint32_t i = list_[k];
      Vec3d m = motion_[i] * memory;
      if (dot(m, push_[i]) < 0.0) m = m * 0.5;
      m += push_[i] * step;
      const double length = norm(m), limit = longest_step * s_.diameter[i];
      if (length > limit) m = m * (limit / length);
      if (dot(push_[i], push_[i]) == 0.0 && length < still * s_.diameter[i]) m = {};
      motion_[i] = m;
      if (m == Vec3d{}) continue;
      s_.position[i] += m;
      if (all) continue;
      wake(i);
      for (std::uint32_t j = vicinity_.first[i]; j < vicinity_.first[i + 1]; ++j) wake(vicinity_.other[j]);
    }
  }

  void wake(std::uint32_t i) { std::atomic_ref<std::uint8_t>(awake_[i]).store(1, std::memory_order_relaxed); }

  PackingState& s_;
  const TriangleTree& walls_;
  Vicinity vicinity_;
  std::vector<Vec3d> motion_, push_;
  std::vector<double> worst_;
  std::vector<std::uint8_t> awake_;
  std::vector<std::uint32_t> list_;
};

}  // namespace

int relax_overlaps(PackingState& s, const TriangleTree& walls, double largest) {
  return Relaxation(s, walls, largest).run();
}

void drop_misplaced(PackingState& s, const TriangleTree& walls,
                    const std::function<std::vector<bool>(const std::vector<Vec3d>&)>& contains, double largest) {
  std::vector<bool> wanted = contains(s.position);
  keep(s, wanted);
  Vicinity vicinity(walls, largest, inflation);
  vicinity.renew(s);
  wanted.assign(s.position.size(), true);
  for (std::size_t i = 0; i < s.position.size(); ++i) {
    const double radius = 0.5 * s.diameter[i];
    for (std::size_t k = vicinity.first_wall[i]; k < vicinity.first_wall[i + 1]; ++k) {
      const Vec3d* c = walls.corners(vicinity.wall[k]);
      const double distance = norm(s.position[i] - closest_point(s.position[i], c[0], c[1], c[2]));
      if (radius - distance > packing_overlap * s.diameter[i]) wanted[i] = false;
    }
  }
  keep(s, wanted);
}

double largest_overlap(const PackingState& s, const TriangleTree& walls, double largest) {
  if (s.position.empty()) return 0.0;
  Vicinity vicinity(walls, largest, inflation);
  vicinity.renew(s);
  double worst = 0.0;
#pragma omp parallel for schedule(static, 1024) reduction(max : worst)
  for (std::size_t i = 0; i < s.position.size(); ++i) worst = std::max(worst, push_on(i, s, vicinity, walls).worst);
  return std::max(worst, 0.0);
}

}  // namespace gdesp::geometry
