// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/body_builder.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <utility>

#include "core/error.hpp"
#include "geometry/solitary_wave.hpp"

namespace gdesp::geometry {
namespace {

constexpr double forever = 1e5;  // s; a constant velocity is tabulated up to here
constexpr double columns_a_depth = 5.0;

bool four_numbers(const std::string& line, double (&v)[4]) {
  std::size_t at = 0;
  for (double& value : v) {
    const auto start = line.find_first_not_of(" \t,;\r", at);
    if (start == std::string::npos) return false;
    at = std::min(line.find_first_of(" \t,;\r", start), line.size());
    const auto r = std::from_chars(line.data() + start + (line[start] == '+'), line.data() + at, value);
    if (r.ec != std::errc() || r.ptr != line.data() + at || !std::isfinite(value)) return false;
  }
  return true;
}

}  // namespace

PrescribedMotion read_motion(const std::string& path) {
  std::ifstream in(path);
  if (!in) throw Error(ErrorKind::input, path + ": cannot be opened (motion_csv: t,dx,dy,dz)");
  PrescribedMotion motion;
  std::string line;
  bool first = true;
  for (int number = 1; std::getline(in, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos || line.front() == '#') continue;
    double v[4];
    const bool may_be_header = std::exchange(first, false);
    if (!four_numbers(line, v)) {
      if (may_be_header) continue;
      throw Error(ErrorKind::input, path + ":" + std::to_string(number) + ": expected t,dx,dy,dz (s, m), found \"" +
                                        line.substr(0, 60) + "\"");
    }
    if (!motion.time.empty() && v[0] <= motion.time.back()) {
      throw Error(ErrorKind::input, path + ":" + std::to_string(number) + ": time " + std::to_string(v[0]) +
                                        " s does not follow " + std::to_string(motion.time.back()) +
                                        " s; times must increase");
    }
    motion.time.push_back(v[0]);
    motion.displacement.push_back({v[1], v[2], v[3]});
  }
  if (motion.time.empty()) throw Error(ErrorKind::input, path + ": holds no line of t,dx,dy,dz");
  return motion;
}

PrescribedMotion constant_motion(const Vec3d& velocity, double start, double stop) {
  PrescribedMotion motion;
  if (norm(velocity) == 0.0) {
    motion.time = {0.0};
    motion.displacement = {{}};
    return motion;
  }
  const double end = std::min(stop, start + forever);
  motion.time = {start, std::max(end, start + 1e-12)};
  motion.displacement = {{}, velocity * (end - start)};
  return motion;
}

Body moving_body(const MovingBody& body, double gravity) {
  Body out;
  out.name = body.name;
  if (body.far_lake.length > 0.0) {
    out.kind = BodyKind::far_lake;
    return out;
  }
  out.kind = BodyKind::prescribed;
  const Wave& wave = body.wave;
  if (wave.kind == "solitary") {
    out.motion = solitary_wave_motion(wave.height, wave.depth, gravity, wave.direction * (1.0 / norm(wave.direction)),
                                      body.start);
  } else {
    out.motion =
        body.motion_csv.empty() ? constant_motion(body.velocity, body.start, body.stop) : read_motion(body.motion_csv);
  }
  out.motion.remove_at = body.remove_at;
  return out;
}

FarLakeShape far_lake_behind(const MovingBody& body, const Box& box, const FluidTable& water, double dp,
                             int dimensions) {
  const FarLakeKeys& keys = body.far_lake;
  FarLakeShape lake;
  lake.length = keys.length;
  lake.depth = keys.depth;
  lake.columns = keys.columns > 0
                     ? static_cast<int>(keys.columns)
                     : std::max(8, static_cast<int>(std::ceil(columns_a_depth * keys.length / keys.depth)));
  lake.side = keys.side == "x+" ? 1.0 : -1.0;
  lake.wall = keys.side == "x+" ? box.lower.x : box.upper.x;
  Box layer = empty_box();  // of the water that touches the wall
  double particles = 0.0;
  for (const Vec3d& r : water.position) {
    const double away = lake.side * (lake.wall - r.x);
    if (away < 0.0 || away >= dp * (1.0 - 1e-9)) continue;
    extend(layer, r);
    particles += 1.0;
  }
  const std::string where = "piston \"" + body.name + "\": far_lake: ";
  if (particles == 0.0)
    throw Error(ErrorKind::input,
                where + "no water touches the face on the other side of it (far_lake.side = \"" + keys.side + "\")");
  const double depth = layer.upper.z - layer.lower.z + dp;
  if (std::abs(depth - lake.depth) > 1.01 * dp)
    throw Error(ErrorKind::input, where + "depth = " + std::to_string(lake.depth) +
                                      " m, but the water at the piston is " + std::to_string(depth) + " m deep");
  lake.level = layer.lower.z - 0.5 * dp + lake.depth;
  if (dimensions == 2) return lake;
  lake.width = layer.upper.y - layer.lower.y + dp;
  const double area = particles * dp * dp;
  if (std::abs(area - lake.width * depth) > 0.05 * area)
    throw Error(ErrorKind::input, where + "the water at the piston is no rectangle: " + std::to_string(lake.width) +
                                      " m wide, " + std::to_string(depth) + " m deep, but an area of " +
                                      std::to_string(area) + " m2");
  return lake;
}

Body prescribed_slide(const Slide& slide) {
  Body out;
  out.name = slide.name;
  out.kind = BodyKind::prescribed;
  out.motion = read_motion(slide.motion_csv);
  for (auto& t : out.motion.time) t += slide.release_at;
  return out;
}

void hold(Body& body, double release_at, const std::vector<std::string>& fixed) {
  body.release_at = release_at;
  for (const std::string& motion : fixed) body.fixed[motion == "rotation" ? 3 : motion[0] - 'x'] = true;
}

Body free_body(const std::string& name, const SolidPart& part, double density, const Vec3d& velocity, int dimensions) {
  MassProperties m = mass_properties(part.mesh);
  if (!(m.volume > 0.0)) throw Error(ErrorKind::input, part.name + ": encloses no volume");
  Body out;
  out.name = name;
  out.kind = BodyKind::free;
  out.velocity = velocity;
  out.centre = m.centre;
  double per_width = 1.0;
  if (dimensions == 2) {
    const Box b = bounds(part.mesh);
    per_width = 1.0 / (b.upper.y - b.lower.y);
    out.centre.y = 0.0;
  }
  out.mass = density * m.volume * per_width;
  for (int k = 0; k < 9; ++k) out.inertia[k] = density * m.inertia_per_density[k] * per_width;
  return out;
}

}  // namespace gdesp::geometry
