// SPDX-License-Identifier: GPL-3.0-or-later
#include "session.hpp"

#include <algorithm>

#include "checkpoint_files.hpp"
#include "exec/backend.hpp"
#include "exec/profile.hpp"
#include "moving_surfaces.hpp"
#include "scene_economy.hpp"

namespace gdesp::tool {
namespace {

constexpr double standard_frames = 50.0;

std::string name_of_device(const std::string& device, int threads) {
  if (device == "cpu") return "cpu, " + std::to_string(threads) + (threads == 1 ? " thread" : " threads");
  for (const auto& d : exec::cuda_devices())
    if (device == "cuda:" + std::to_string(d.number)) return device + ", " + d.name;
  return device;
}

template <class T>
void add(Checksum& sum, const std::vector<T>& values) {
  sum.add(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

std::uint64_t fingerprint_of(const Case& c) {
  Scene scene = c.scene;
  scene.time = {};
  const std::string text = scene_to_toml(scene);
  Checksum sum;
  sum.add(text.data(), text.size());
  add(sum, c.fluid.position);
  add(sum, c.fluid.velocity);
  add(sum, c.boundary.position);
  add(sum, c.boundary.friction);
  add(sum, c.boundary.body);
  add(sum, c.grains.position);
  add(sum, c.grains.diameter);
  add(sum, c.grains.density);
  add(sum, c.walls.vertex);
  add(sum, c.walls.body);
  return sum.value();
}

}  // namespace

Session prepare(RunOptions options) {
  Session s;
  s.device = resolve_device(options.device);
  s.threads = exec::set_threads(options.threads);
  s.device_name = name_of_device(s.device, s.threads);
  cli::detail("reading " + options.case_path);
  s.scene_case = read_case(options.case_path, options.overrides);
  TimeControl& time = s.scene_case.scene.time;
  if (options.t_end) time.end = *options.t_end;
  s.times = {time.output_interval > 0.0 ? time.output_interval : time.end / standard_frames, time.end};
  if (options.output_interval) s.times.interval = *options.output_interval;
  s.fingerprint = fingerprint_of(s.scene_case);
  const ExpectedSpeed expected = expected_speed(s.scene_case);
  s.input = case_to_input(s.scene_case);
  s.summary = summarize(s.scene_case.scene, s.input, expected, s.device, s.threads);
  const auto is_free = [](const Body& body) { return body.kind == BodyKind::free; };
  if (s.summary.moving_particles == 0 && std::none_of(s.input.bodies.begin(), s.input.bodies.end(), is_free))
    throw Error(ErrorKind::input,
                options.case_path + ": has neither water nor grains nor a free body; there is nothing to simulate");
  if (s.device != "cpu") refuse_disagreement(disagreement(s.input, s.device), s.device);
  describe_economies(s.summary, s.scene_case.scene, s.input, expected, measure_step_costs(s.input, s.device));
  exec::set_profiling(options.profile);
  s.options = std::move(options);
  return s;
}

void start(Session& s) {
  check_memory(s.summary, s.scene_case.scene, s.device, available_memory(s.device));
  s.simulation = make_simulation(s.input, s.device);
  s.input = {};
}

Frame frame_of(Session& s) {
  Simulation& simulation = *s.simulation;
  Frame frame;
  frame.time = simulation.time();
  frame.step = simulation.step_count();
  frame.fluid = simulation.fluid();
  frame.grains = simulation.grains();
  const auto& bodies = s.scene_case.bodies;
  if (bodies.empty()) return frame;
  const auto poses = simulation.bodies();
  frame.bodies = moving_surfaces(s.scene_case.walls, bodies, poses, frame.time);
  frame.body_states = body_states(bodies, poses, frame.time);
  frame.far_lakes = simulation.far_lakes();
  return frame;
}

}  // namespace gdesp::tool
