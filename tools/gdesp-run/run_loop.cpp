// SPDX-License-Identifier: GPL-3.0-or-later
#include "run_loop.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <iostream>

#include "checkpoint_files.hpp"
#include "core/version.hpp"
#include "exec/array.hpp"
#include "exec/profile.hpp"
#include "failure_files.hpp"
#include "frame_output.hpp"
#include "offender.hpp"
#include "recovery.hpp"
#include "run_files.hpp"
#include "session.hpp"

namespace gdesp::tool {
namespace {

using nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;
// Of what the machine has, for the good states in memory.
constexpr double good_states_share = 0.3;

/// Steps between good states: a copy of everything takes as long as a few steps, more where it comes off a card. The
/// number is fixed, not measured, so that a run that had to go back can be repeated.
std::int64_t steps_between_good_states(const std::string& device) { return device == "cpu" ? 500 : 5000; }

GuardSetup guard_setup(const Session& s) {
  const Scene& scene = s.scene_case.scene;
  GuardSetup setup;
  setup.spacing_energy = norm(scene.gravity) * scene.dp;
  const std::vector<Body>& bodies = s.scene_case.bodies;
  setup.watches_energy =
      std::all_of(bodies.begin(), bodies.end(), [](const Body& body) { return body.kind == BodyKind::far_lake; });
  for (const std::string& axis : scene.periodic)
    if ((axis == "x" ? scene.gravity.x : scene.gravity.y) != 0.0) setup.watches_energy = false;  // it falls for ever
  return setup;
}

ordered_json frame_record(const FramePaths& paths, const std::string& case_path) {
  ordered_json record{{"record", "frame"}, {"path", paths.fluid.empty() ? paths.grains : paths.fluid}};
  if (!paths.fluid.empty()) record["fluid"] = paths.fluid;
  if (!paths.grains.empty()) record["grains"] = paths.grains;
  if (!paths.bodies.empty()) record["bodies"] = paths.bodies;
  record["case"] = case_path;
  record["t"] = paths.time;
  record["step"] = paths.step;
  return record;
}

ordered_json run_description(const Session& s) {
  std::string command = "gdesp-run";
  for (const std::string& argument : s.options.arguments) command += " " + argument;
  ordered_json overrides = ordered_json::array();
  for (const Override& o : s.options.overrides) overrides.push_back(o.key + "=" + o.value);
  return {{"program", "gdesp-run"},
          {"version", gdesp::version},
          {"commit", gdesp::commit},
          {"build", std::string(gdesp::compiler) + ", " + gdesp::build_type},
          {"command", command},
          {"case", s.options.case_path},
          {"overrides", overrides},
          {"device", s.device},
          {"device_name", s.device_name},
          {"threads", s.threads},
          {"started", utc_now()},
          {"t_end", s.times.end},
          {"output_interval", s.times.interval},
          {"log_every", s.options.log_every},
          {"scene", s.summary.json}};
}

/// One run under way: the simulation, its output, its clock.
class Run {
 public:
  Run(Session session, const std::optional<Checkpoint>& resumed)
      : session_(std::move(session)), terminal_(cli::stdout_is_terminal()),
        output_(open_folder(session_), [this](const FramePaths& paths) { frame_written(paths); }),
        log_(session_.options.run_folder, resumed ? resumed->step : -1, resumed ? resumed->watch.recoveries : 0),
        guard_(guard_setup(session_)), recovery_(good_states_share * available_memory("cpu")),
        checkpoints_(session_.options.run_folder, session_.fingerprint), start_is_out_(resumed.has_value()),
        description_(run_description(session_)) {
    if (resumed) {
      earlier_seconds_ = saved_ = resumed->wall_seconds;
      guard_ = resumed->watch.guard;
      recovery_.take_over(resumed->watch, resumed->good);
      description_["resumed_at_step"] = resumed->step;
      tell_earlier_frames();
    }
    write_status("running", {});
  }

  int go() {
    try {
      const int code = steps();
      output_.drain();
      if (reader_gone_) leave();
      finish(code);
      return code;
    } catch (const Error& problem) {
      fail(problem.what());
      throw;
    }
  }

 private:
  static FrameWriter open_folder(const Session& s) {
    const RunOptions& o = s.options;
    FrameWriter writer(o.run_folder, s.scene_case.offset, s.scene_case.scene.dp, o.force, o.resume);
    tidy_run_folder(o.run_folder, o.resume);
    write_run_case_path(o.run_folder, o.case_path);
    return writer;
  }

  Simulation& simulation() { return *session_.simulation; }
  double wall_seconds() const {
    return earlier_seconds_ + std::chrono::duration<double>(Clock::now() - begun_).count();
  }
  double score() {
    return static_cast<double>(session_.summary.moving_particles) * simulation().time() / wall_seconds();
  }

  void frame_written(const FramePaths& paths) {
    if (terminal_ || reader_gone_) return;
    try {
      cli::write_record(frame_record(paths, session_.options.case_path));
    } catch (const Error&) { throw; } catch (...) {  // a closed pipe is no std::exception
      closed_pipe_ = std::current_exception();
      reader_gone_ = true;
    }
  }

  /// Nobody reads our records any more: the tool ends quietly, and the run can go on later.
  [[noreturn]] void leave() {
    write_status(simulation().time() < session_.times.end ? "interrupted" : "done",
                 "the reader of the records has gone");
    std::rethrow_exception(closed_pipe_);
  }

  /// Whoever reads our records gets the frames from before the interruption too.
  void tell_earlier_frames() {
    for (const FramePaths& paths : list_frames(session_.options.run_folder))
      if (paths.time <= simulation().time()) frame_written(paths);
  }

  int steps() {
    if (!recovery_.has_state()) recovery_.keep(simulation(), guard_);  // the start itself
    while (!start_is_out_) start_is_out_ = put_out();
    cli::Progress progress("simulating");
    const double first = simulation().time(), end = session_.times.end;
    while (simulation().time() < end) {
      const double next = session_.times.next(simulation().time());
      bool good = true;
      while (good && simulation().time() < next) {
        good = advance(next);
        output_.check();
        tell(progress, first);
        if (told_to_stop() || checkpoint_is_due()) break;
      }
      if (good && simulation().time() >= next) put_out();
      const bool stop = told_to_stop() && simulation().time() < end;
      if (stop || checkpoint_is_due()) save();
      if (stop) return 130;
    }
    progress.done();
    return 0;
  }

  bool told_to_stop() const { return cli::interrupted() || reader_gone_; }
  bool checkpoint_is_due() const { return wall_seconds() - saved_ >= session_.options.checkpoint_every; }

  /// All frames up to now are on disk before the checkpoint that follows them.
  void save() {
    output_.drain();
    checkpoint_ = checkpoints_.write(simulation(), guard_, recovery_, wall_seconds());
    saved_ = wall_seconds();
    cli::detail("checkpoint at t = " + number_text(checkpoint_->time) + " s: " + checkpoint_->path);
  }

  /// A frame; none, and false, when the state is in trouble and the run is back at a good one.
  bool put_out() {
    if (const auto trouble = note()) {
      go_back(*trouble);
      return false;
    }
    output_.push(frame_of(session_));
    return true;
  }

  /// One step; false when it led into trouble, and the run is back at a good state.
  bool advance(double next) {
    std::optional<Trouble> trouble;
    try {
      simulation().step(next);
      trouble = guard_.after_step(simulation());
    } catch (const Error& problem) {
      if (problem.kind() != ErrorKind::numerical) throw;
      trouble = Guard::broken(simulation(), problem.what());
    }
    const std::int64_t step = simulation().step_count();
    if (!trouble && step % steps_between_diagnostics == 0) {
      trouble = note();
    } else if (!trouble && step % session_.options.log_every == 0) {
      log_.add(simulation().diagnostics());
    }
    if (trouble) {
      go_back(*trouble);
      return false;
    }
    if (step % steps_between_good_states(session_.device) == 0) {
      recovery_.relax(simulation());
      recovery_.keep(simulation(), guard_);
    }
    return true;
  }

  std::optional<Trouble> note() {
    const exec::ProfileScope scope("guard::diagnostics");
    latest_ = simulation().diagnostics();
    auto trouble = guard_.look(latest_, [](const std::string& text) { cli::warning(text); });
    if (!trouble) log_.add(latest_);
    return trouble;
  }

  /// Back to a good state, with more caution; or, when that has been tried enough, the end.
  void go_back(const Trouble& trouble) {
    std::optional<Offender> offender = find_offender(simulation(), trouble, session_.scene_case.scene.fluid.density);
    if (!recovery_.may_try()) give_up(trouble, offender);
    const ordered_json record = recovery_.go_back(simulation(), guard_, trouble);
    find_place(offender);
    log_.go_back(record["step"].get<std::int64_t>(), record);
    description_["recoveries"].push_back(record);
    cli::warning(trouble_text(trouble, offender) + "; going back to t = " + number_text(simulation().time(), 6) +
                 " s, on with " + number_text(record["step_factor"].get<double>(), 3) +
                 " of the time step and a sound speed of " + number_text(simulation().sound_speed()) + " m/s (try " +
                 std::to_string(record["try"].get<int>()) + " of " + std::to_string(Recovery::most_tries) + ")");
  }

  /// A particle whose state is no number is where it was in the good state.
  void find_place(std::optional<Offender>& offender) {
    if (!offender || offender->has_place) return;
    const std::optional<Vec3d> place = place_of(simulation(), *offender);
    offender->has_place = place.has_value();
    offender->place = place.value_or(Vec3d{});
  }

  std::string trouble_text(const Trouble& trouble, const std::optional<Offender>& offender) const {
    return moment_text(trouble.step, trouble.time) + trouble.what +
           (offender ? "; " + offender_text(*offender, session_.scene_case.offset) : "");
  }

  /// Writes the state in trouble and the last good one (also as a checkpoint), and throws.
  [[noreturn]] void give_up(const Trouble& trouble, std::optional<Offender> offender) {
    const std::string& run = session_.options.run_folder;
    output_.drain();
    ordered_json report{
        {"cause", trouble.what}, {"remedy", trouble.remedy}, {"step", trouble.step}, {"t", trouble.time}};
    report["offending"] = write_failure_state(run, "offending", frame_of(session_));
    const std::string tries = recovery_.tries_text(simulation());
    if (recovery_.has_state()) {
      recovery_.restore_newest(simulation());
      find_place(offender);
      report["good"] = write_failure_state(run, "good", frame_of(session_));
      report["good"]["checkpoint"] = checkpoints_.write(simulation(), guard_, recovery_, wall_seconds()).path;
    }
    const std::string message = trouble_text(trouble, offender) + tries + ". What to change: " + trouble.remedy + ". " +
                                run + "/failure holds this state" +
                                (recovery_.has_state() ? " and the last good one" : "");
    report["message"] = message;
    write_failure_report(run, report);
    throw Error(ErrorKind::numerical, message);
  }

  void tell(cli::Progress& progress, double first) {
    const double now = wall_seconds();
    if (now - told_ < 0.2) return;
    told_ = now;
    const double t = simulation().time(), end = session_.times.end;
    progress.update((t - first) / (end - first), "t " + number_text(t) + " of " + number_text(end) + " s  dt " +
                                                     number_text(simulation().last_time_step(), 2) + " s (" +
                                                     simulation().limited_by() + ")  score " + number_text(score(), 3));
  }

  void write_status(const char* status, const std::string& message) {
    description_["status"] = status;
    if (!message.empty()) description_["message"] = message;
    description_["steps"] = simulation().step_count();
    description_["t"] = simulation().time();
    description_["wall_seconds"] = wall_seconds();
    description_["processor_seconds"] = static_cast<double>(std::clock() - processor_begun_) / CLOCKS_PER_SEC;
    description_["score"] = score();
    description_["memory"] = exec::peak_allocated_bytes();
    if (session_.options.profile)
      for (const auto& row : exec::profile())
        description_["profile"][row.name] = {{"seconds", row.seconds}, {"calls", row.calls}};
    write_run_json(session_.options.run_folder, description_);
  }

  void finish(int code) {
    const bool done = code == 0;
    write_status(done ? "done" : "interrupted", {});
    ordered_json record{{"record", done ? "done" : "interrupted"},
                        {"run", session_.options.run_folder},
                        {"case", session_.options.case_path},
                        {"steps", simulation().step_count()},
                        {"t", simulation().time()},
                        {"wall_seconds", wall_seconds()},
                        {"particles", session_.summary.moving_particles},
                        {"lost", latest_.lost_fluid + latest_.lost_grains},
                        {"score", score()},
                        {"device", session_.device}};
    if (!done && checkpoint_) {
      record["checkpoint"] = checkpoint_->path;
      cli::info("interrupted at t = " + number_text(simulation().time()) + " s; gdesp-run --resume -o " +
                session_.options.run_folder + " goes on");
    }
    if (!terminal_)
      cli::write_record(record);
    else
      std::cout << summary_text(done) << std::flush;
    if (session_.options.profile) tell_profile();
  }

  std::string summary_text(bool done) {
    return (done ? "done: " : "interrupted: ") + std::to_string(simulation().step_count()) +
           " steps to t = " + number_text(simulation().time()) + " s in " + duration_text(wall_seconds()) + " (score " +
           number_text(score(), 3) + "), " + session_.device_name + "\nframes: " + session_.options.run_folder + "\n";
  }

  void tell_profile() {
    const auto rows = exec::profile();
    for (const auto& row : rows) {
      char line[120];
      std::snprintf(line, sizeof line, "%-28s %9.3f s  %5.1f %%  %9ld calls", row.name.c_str(), row.seconds,
                    100.0 * row.seconds / wall_seconds(), row.calls);
      cli::info(line);
    }
  }

  /// The frames so far reach the disk, the reader downstream hears of the failure; the failure itself matters more
  /// than trouble on the way.
  void fail(const std::string& message) {
    const auto attempt = [](const auto& part) {
      try {
        part();
      } catch (...) {}
    };
    attempt([&] { output_.drain(); });
    attempt([&] { write_status("failed", message); });
    if (terminal_) return;
    attempt([&] {
      cli::write_record({{"record", "failed"},
                         {"reason", message},
                         {"message", message},
                         {"t", simulation().time()},
                         {"step", simulation().step_count()},
                         {"run", session_.options.run_folder}});
    });
  }

  Session session_;
  bool terminal_;
  std::atomic<bool> reader_gone_{false};
  std::exception_ptr closed_pipe_;  // set before reader_gone_
  Clock::time_point begun_ = Clock::now();
  std::clock_t processor_begun_ = std::clock();
  double earlier_seconds_ = 0.0, told_ = 0.0, saved_ = 0.0;  // s of wall time: before a resumption; last said, saved
  FrameOutput output_;
  DiagnosticsLog log_;
  Diagnostics latest_;
  Guard guard_;
  Recovery recovery_;
  CheckpointFiles checkpoints_;
  std::optional<Checkpoint> checkpoint_;
  bool start_is_out_;  ///< the frame of the start; a checkpoint follows it, also one of the start itself, gone back to
  ordered_json description_;
};

std::optional<Checkpoint> resume(Session& session) {
  auto checkpoint = CheckpointFiles(session.options.run_folder, session.fingerprint).load_newest(*session.simulation);
  if (checkpoint)
    cli::info("goes on at t = " + number_text(checkpoint->time) + " s, step " + std::to_string(checkpoint->step));
  else
    cli::info("no checkpoint yet: starts from the beginning");
  return checkpoint;
}

}  // namespace

int run_case(RunOptions options) {
  Session session = prepare(std::move(options));
  for (const std::string& line : session.summary.lines) cli::info(line);
  start(session);
  std::optional<Checkpoint> checkpoint;
  if (session.options.resume) checkpoint = resume(session);
  return Run(std::move(session), checkpoint).go();
}

}  // namespace gdesp::tool
