// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "io/case.hpp"
#include "io/frame.hpp"
#include "support/temp_folder.hpp"

namespace gdesp::test {

/// Values that differ from particle to particle and component to component.
class Numbers {
 public:
  double next() { return distribution_(engine_); }
  Vec3d place() { return {5e6 + next(), next(), -1e-3 * next()}; }
  Vec3f arrow() { return {float(next()), float(next()), float(next())}; }

 private:
  std::mt19937 engine_{42};
  std::uniform_real_distribution<double> distribution_{0.5, 100.0};
};

inline FluidTable some_fluid(std::size_t count) {
  Numbers n;
  FluidTable f;
  for (std::size_t i = 0; i < count; ++i) {
    f.position.push_back(n.place());
    f.velocity.push_back(n.arrow());
    f.density.push_back(float(n.next()));
    f.pressure.push_back(float(n.next()));
    f.porosity.push_back(float(n.next()));
    f.id.push_back(4294967295u - std::uint32_t(i));
  }
  return f;
}

inline GrainTable some_grains(std::size_t count) {
  Numbers n;
  GrainTable g;
  for (std::size_t i = 0; i < count; ++i) {
    g.position.push_back(n.place());
    g.diameter.push_back(float(n.next()));
    g.density.push_back(float(n.next()));
    g.velocity.push_back(n.arrow());
    g.angular_velocity.push_back(n.arrow());
    g.group.push_back(std::int32_t(i % 2));
    g.id.push_back(std::uint32_t(i));
    g.porosity.push_back(float(n.next()));
  }
  return g;
}

/// Two triangles at rest and one of body 1.
inline TriangleTable some_triangles() {
  TriangleTable t;
  t.vertex = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {5, 5, 5}, {6, 5, 5}, {5, 6, 5}};
  t.triangle = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}};
  t.body = {0, 0, 1};
  return t;
}

inline void expect_same(const FluidTable& a, const FluidTable& b) {
  EXPECT_TRUE(a.position == b.position);
  EXPECT_TRUE(a.velocity == b.velocity);
  EXPECT_TRUE(a.density == b.density);
  EXPECT_TRUE(a.pressure == b.pressure);
  EXPECT_TRUE(a.porosity == b.porosity);
  EXPECT_TRUE(a.id == b.id);
}

inline void expect_same(const GrainTable& a, const GrainTable& b) {
  EXPECT_TRUE(a.position == b.position);
  EXPECT_TRUE(a.diameter == b.diameter);
  EXPECT_TRUE(a.density == b.density);
  EXPECT_TRUE(a.velocity == b.velocity);
  EXPECT_TRUE(a.angular_velocity == b.angular_velocity);
  EXPECT_TRUE(a.group == b.group);
  EXPECT_TRUE(a.id == b.id);
  EXPECT_TRUE(a.porosity == b.porosity);
}

inline void expect_same(const TriangleTable& a, const TriangleTable& b) {
  EXPECT_TRUE(a.vertex == b.vertex);
  EXPECT_TRUE(a.triangle == b.triangle);
  EXPECT_TRUE(a.body == b.body);
}

/// Runs `action`, which must throw an Error of the kind whose message holds all `parts`.
template <class Action>
void expect_error(ErrorKind kind, const std::vector<std::string>& parts, Action action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    for (const std::string& part : parts)
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << part << " not in: " << error.what();
    return;
  }
  ADD_FAILURE() << "no error; expected one that mentions " << (parts.empty() ? "" : parts.front());
}

/// Reads `count` files made of the text with a few bytes changed: each is read, or refused as input.
inline void expect_changed_bytes_do_no_harm(const TempFolder& folder, const std::string& path, int count) {
  const std::string text = text_of_file(path), ending = path.substr(path.rfind('.'));
  std::mt19937 engine(13);
  for (int i = 0; i < count; ++i) {
    std::string changed = text;
    for (int k = 0; k <= i % 4; ++k) changed[engine() % changed.size()] = char(engine());
    try {
      read_fluid_frame(folder.write("changed" + ending, changed), {}, nullptr);
    } catch (const Error& error) { EXPECT_EQ(error.kind(), ErrorKind::input) << error.what(); }
  }
}

}  // namespace gdesp::test
