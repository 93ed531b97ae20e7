// SPDX-License-Identifier: GPL-3.0-or-later
#include "sph/activity.hpp"

#include <cmath>

#include "exec/flags.hpp"

namespace gdesp::sph {
namespace {

constexpr double mover_share = 0.01;  // of the splash speed: walls at rest do not tremble

// Whole units a m/s (or m/s2): a mean of a millionth of the scale is seen, and 1e6 times the scale does not overflow.
double units_per(double scale) { return 16777216.0 / scale; }

// Sums of a block: velocity (or acceleration) in units, particles, those that are fast.
enum BlockRow { block_x, block_y, block_z, block_count, block_fast, block_rows };

struct AddWater {
  BlockGrid grid;
  const FixedPosition* position;
  const Vec3f* velocity;
  const std::uint32_t* id;
  double units;  // per m/s
  float fast2;   // (m/s)^2
  std::int64_t* sums;
  GDESP_HD void operator()(Index s) const {
    if (id[s] == no_particle) return;
    const Vec3f v = velocity[s];
    std::int64_t* sum = sums + static_cast<std::int64_t>(block_rows) * grid.block_of(position[s]);
    exec::add_units(sum + block_count, 1);
    const float v2 = dot(v, v);
    if (v2 == 0.0f) return;
    exec::add_units(sum + block_x, ::llrint(static_cast<double>(v.x) * units));
    exec::add_units(sum + block_y, ::llrint(static_cast<double>(v.y) * units));
    exec::add_units(sum + block_z, ::llrint(static_cast<double>(v.z) * units));
    if (!(v2 < fast2)) exec::add_units(sum + block_fast, 1);
  }
};

// Where there is water, when it does not matter how it moves.
struct MarkWater {
  BlockGrid grid;
  const FixedPosition* position;
  const std::uint32_t* id;
  std::int64_t* sums;
  GDESP_HD void operator()(Index s) const {
    if (id[s] == no_particle) return;
    exec::set_flag(sums + static_cast<std::int64_t>(block_rows) * grid.block_of(position[s]) + block_count);
  }
};

struct AddMovers {
  BlockGrid grid;
  Movers movers;
  float fast2;
  std::int64_t* sums;
  GDESP_HD void operator()(Index s) const {
    if (movers.id[s] == no_particle) return;
    const Vec3f v = movers.velocity[s];
    if (!movers.always && dot(v, v) < fast2) return;
    exec::add_units(sums + static_cast<std::int64_t>(block_rows) * grid.block_of(movers.position[s]) + block_fast, 1);
  }
};

struct Judge {
  const std::int64_t* sums;
  double limit;  // of the mean, in units; < 0: water as such counts
  double t;
  double* disturbed_at;
  GDESP_HD void operator()(Index b) const {
    const std::int64_t* sum = sums + static_cast<std::int64_t>(block_rows) * b;
    if (limit < 0.0 && sum[block_count] > 0) disturbed_at[b] = t;
    if (limit < 0.0) return;
    const double x = static_cast<double>(sum[block_x]), y = static_cast<double>(sum[block_y]);
    const double z = static_cast<double>(sum[block_z]), most = limit * static_cast<double>(sum[block_count]);
    if (sum[block_fast] > 0 || x * x + y * y + z * z > most * most) disturbed_at[b] = t;
  }
};

struct Forget {
  double* disturbed_at;
  GDESP_HD void operator()(Index b) const { disturbed_at[b] = -1.0e300; }
};

struct WakeAround {
  BlockGrid grid;
  const double* disturbed_at;
  double since;  // s
  int halo;
  Index* awake;
  GDESP_HD void operator()(Index b) const {
    const Vec3<std::int32_t> at = grid.coordinates(b);
    Index any = 0;
    for (int z = -halo; z <= halo; ++z)
      for (int y = -halo; y <= halo; ++y)
        for (int x = -halo; x <= halo; ++x) {
          const Index other = grid.number(grid.inside(at.x + x, 0), grid.inside(at.y + y, 1), grid.inside(at.z + z, 2));
          if (disturbed_at[other] >= since) any = 1;
        }
    awake[b] = any;
  }
};

struct Beside {
  BlockGrid grid;
  const Index* awake;
  Index* near;
  GDESP_HD void operator()(Index b) const {
    const Vec3<std::int32_t> at = grid.coordinates(b);
    Index any = 0;
    for (int z = -1; z <= 1; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x)
          any |= awake[grid.number(grid.inside(at.x + x, 0), grid.inside(at.y + y, 1), grid.inside(at.z + z, 2))];
    near[b] = any;
  }
};

struct FlagClusters {
  BlockGrid grid;
  const Index* mark;
  const FixedPosition* position;
  const std::uint32_t* id;
  Index* flag;
  GDESP_HD void operator()(Index c) const {
    Index any = mark ? 0 : 1;
    for (Index s = exec::cluster_size * c; !any && s < exec::cluster_size * (c + 1); ++s)
      if (id[s] != no_particle) any |= mark[grid.block_of(position[s])];
    flag[c] = any;
  }
};

struct ListClusters {
  const Index* flag;
  const Index* place;
  Index* list;
  GDESP_HD void operator()(Index c) const {
    if (flag[c]) list[place[c]] = c;
  }
};

}  // namespace

template <class Exec>
void ClusterSelection<Exec>::choose(const BlockGrid& grid, const Index* mark, const FixedPosition* position,
                                    const std::uint32_t* id, Index clusters) {
  const auto n = static_cast<std::size_t>(clusters);
  flag_.resize_discard(n);
  place_.resize_discard(n + 1);
  list_.resize_discard(n);
  exec::parallel_for(exec_, "activity::flag", clusters, FlagClusters{grid, mark, position, id, flag_.data()});
  count_ = clusters > 0 ? exec::exclusive_scan(exec_, "activity::scan", flag_.data(), place_.data(), clusters) : 0;
  exec::parallel_for(exec_, "activity::list", clusters, ListClusters{flag_.data(), place_.data(), list_.data()});
}

template <class Exec>
Activity<Exec>::Activity(const Exec& exec, const Domain& domain, const ActivityParameters& parameters, double dp,
                         double gravity)
    : exec_(exec), parameters_(parameters), dp_(dp), gravity_(gravity), grid_(make_block_grid(domain)), sums_(exec),
      disturbed_at_(exec), awake_(exec), near_(exec) {
  const auto n = static_cast<std::size_t>(grid_.blocks());
  sums_.resize_discard(block_rows * n);
  disturbed_at_.resize_discard(n);
  awake_.resize_discard(n);
  near_.resize_discard(n);
  exec::parallel_for(exec_, "activity::forget", grid_.blocks(), Forget{disturbed_at_.data()});
}

template <class Exec>
double Activity<Exec>::speed_scale() const {
  return std::sqrt(gravity_ * dp_);
}

template <class Exec>
void Activity<Exec>::set_sleeping() {
  sleeps_ = true;
  exec::parallel_for(exec_, "activity::forget", grid_.blocks(), Forget{disturbed_at_.data()});
}

template <class Exec>
void Activity<Exec>::begin() {
  sums_.fill_bytes(0);
}

template <class Exec>
void Activity<Exec>::add_water(const FixedPosition* position, const Vec3f* velocity, const std::uint32_t* id,
                               Index count) {
  if (!sleeps_) {
    exec::parallel_for(exec_, "activity::water", count, MarkWater{grid_, position, id, sums_.data()});
    return;
  }
  const double fast = parameters_.splash_speed * speed_scale();
  exec::parallel_for(
      exec_, "activity::water", count,
      AddWater{grid_, position, velocity, id, units_per(speed_scale()), static_cast<float>(fast * fast), sums_.data()});
}

template <class Exec>
void Activity<Exec>::add_accelerations(const FixedPosition* position, const Vec3f* acceleration,
                                       const std::uint32_t* id, Index count) {
  exec::parallel_for(exec_, "activity::water", count,
                     AddWater{grid_, position, acceleration, id, units_per(gravity_), INFINITY, sums_.data()});
}

template <class Exec>
void Activity<Exec>::add_movers(const Movers& movers) {
  const double fast = mover_share * parameters_.splash_speed * speed_scale();
  if (movers.count > 0)
    exec::parallel_for(exec_, "activity::movers", movers.count,
                       AddMovers{grid_, movers, static_cast<float>(fast * fast), sums_.data()});
}

template <class Exec>
void Activity<Exec>::judge(double t, bool accelerations) {
  const double limit = accelerations ? parameters_.start_acceleration * gravity_ * units_per(gravity_)
                                     : parameters_.wake_speed * speed_scale() * units_per(speed_scale());
  exec::parallel_for(exec_, "activity::judge", grid_.blocks(),
                     Judge{sums_.data(), sleeps_ ? limit : -1.0, t, disturbed_at_.data()});
}

template <class Exec>
void Activity<Exec>::decide(double t) {
  exec::parallel_for(exec_, "activity::wake", grid_.blocks(),
                     WakeAround{grid_, disturbed_at_.data(), t - (sleeps_ ? parameters_.rest_time : 0.0),
                                sleeps_ ? parameters_.halo : 0, awake_.data()});
  exec::parallel_for(exec_, "activity::near", grid_.blocks(), Beside{grid_, awake_.data(), near_.data()});
}

template class ClusterSelection<exec::CompiledBackend>;
template class Activity<exec::CompiledBackend>;

}  // namespace gdesp::sph
