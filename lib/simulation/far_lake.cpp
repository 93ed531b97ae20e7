// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulation/far_lake.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/error.hpp"

namespace gdesp {
namespace {

// Of the midpoint rule; what is left after them is far below the error of the step, which the sound of the particles' water bounds.
constexpr int iterations = 3;
constexpr double most_lacking = 0.15;  // of the force of water at rest

}  // namespace

FarLake::FarLake(const FarLakeShape& shape, double density, double gravity, double settling)
    : shape_(shape), gravity_(gravity), settling_(settling), x_(static_cast<std::size_t>(shape.columns) + 1),
      u_(x_.size(), 0.0), inertia_(columns()), pivot_(columns()), pressure_(columns()), a_(x_.size()),
      middle_(x_.size()) {
  const double spacing = shape.length / shape.columns;
  for (std::size_t i = 0; i < x_.size(); ++i) x_[i] = spacing * static_cast<double>(i);
  area_ = shape.depth * spacing;
  column_mass_ = density * shape.width * area_;
  far_wall_force_ = -0.5 * column_mass_ * gravity_ * shape_.depth / spacing;
}

void FarLake::set_state(std::vector<double> nodes, std::vector<double> velocities) {
  x_ = std::move(nodes);
  u_ = std::move(velocities);
}

void FarLake::settle(double dt, double force) {
  time_ += dt;
  if (time_ >= 0.5 * settling_) {
    rest_impulse_ += dt * force;
    rest_time_ += dt;
  }
  if (time_ < settling_) return;
  const double at_rest = -far_wall_force_, found = rest_impulse_ / rest_time_;
  lacking_ = at_rest - found;
  if (std::abs(lacking_) <= most_lacking * at_rest) return;
  throw Error(ErrorKind::input, "far lake: the water at its wall presses with " + std::to_string(found) +
                                    " N at the start, water at rest " + std::to_string(shape_.depth) + " m deep and " +
                                    std::to_string(shape_.width) + " m wide with " + std::to_string(at_rest) +
                                    " N; far_lake.depth has to be the depth there, and the water at rest");
}

void FarLake::drift(double dt) {
  for (std::size_t i = 0; i < x_.size(); ++i) x_[i] += dt * u_[i];
  for (std::size_t j = 0; j < columns(); ++j) {
    if (length(j) > 0.0) continue;
    throw Error(ErrorKind::numerical, "far lake: column " + std::to_string(j) +
                                          " has been pressed to nothing: the wave in it is too steep for "
                                          "columns; more of the lake has to be particles");
  }
}

// K of the columns as they lie now, and the pivots of the elimination: the nodes 0 .. n-1 are unknown, node n is a wall.
void FarLake::factorise() {
  const std::size_t n = columns();
  for (std::size_t j = 0; j < n; ++j) {
    const double s = depth(j) / length(j);
    inertia_[j] = column_mass_ * s * s / 3.0;
  }
  pivot_[0] = 0.5 * column_mass_ + inertia_[0];
  for (std::size_t i = 1; i < n; ++i)
    pivot_[i] = column_mass_ + inertia_[i - 1] + inertia_[i] - inertia_[i - 1] * inertia_[i - 1] / pivot_[i - 1];
}

void FarLake::solve(const std::vector<double>& u, double force) {
  const std::size_t n = columns();
  for (std::size_t j = 0; j < n; ++j) {
    const double du = u[j + 1] - u[j];
    pressure_[j] = -(2.0 * inertia_[j] * du * du + 0.5 * column_mass_ * gravity_ * depth(j)) / length(j);
  }
  a_[0] = pressure_[0] + force;
  for (std::size_t i = 1; i < n; ++i)
    a_[i] = pressure_[i] - pressure_[i - 1] + inertia_[i - 1] / pivot_[i - 1] * a_[i - 1];
  a_[n] = 0.0;
  for (std::size_t i = n; i-- > 0;) a_[i] = (a_[i] + inertia_[i] * a_[i + 1]) / pivot_[i];
}

void FarLake::step(double dt, double force) {
  const std::size_t n = columns();
  force *= shape_.side;
  if (time_ < settling_) {
    settle(dt, force);
    return;
  }
  drift(0.5 * dt);
  factorise();
  std::fill(a_.begin(), a_.end(), 0.0);
  for (int k = 0; k < iterations; ++k) {
    for (std::size_t i = 0; i <= n; ++i) middle_[i] = u_[i] + 0.5 * dt * a_[i];
    solve(middle_, force + lacking_);
  }
  far_wall_force_ = pressure_[n - 1] - inertia_[n - 1] * a_[n - 1];
  for (std::size_t i = 0; i < n; ++i) u_[i] += dt * a_[i];
  drift(0.5 * dt);
}

FarLakeSums FarLake::sums() const {
  FarLakeSums sums;
  const std::size_t n = columns();
  sums.mass = column_mass_ * static_cast<double>(n);
  for (std::size_t i = 0; i <= n; ++i) {
    const double m = (i == 0 || i == n ? 0.5 : 1.0) * column_mass_;
    sums.momentum += shape_.side * m * u_[i];
    sums.kinetic += 0.5 * m * u_[i] * u_[i];
  }
  for (std::size_t j = 0; j < n; ++j) {
    const double rate = depth(j) / length(j) * (u_[j + 1] - u_[j]);
    sums.kinetic += column_mass_ * rate * rate / 6.0;
    sums.potential += 0.5 * column_mass_ * gravity_ * depth(j);
    sums.highest = std::max(sums.highest, depth(j) / shape_.depth - 1.0);
  }
  return sums;
}

FarLakeTable FarLake::table() const {
  FarLakeTable table;
  for (std::size_t j = 0; j < columns(); ++j) {
    table.x.push_back(shape_.wall + shape_.side * 0.5 * (x_[j] + x_[j + 1]));
    table.level.push_back(shape_.level - shape_.depth + depth(j));
    table.velocity.push_back(shape_.side * 0.5 * (u_[j] + u_[j + 1]));
  }
  return table;
}

}  // namespace gdesp
