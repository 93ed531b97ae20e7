// SPDX-License-Identifier: GPL-3.0-or-later
#include "target.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>

#include "calibration.hpp"
#include "case_to_input.hpp"
#include "io/safe_file.hpp"
#include "run_files.hpp"
#include "run_loop.hpp"
#include "scene_summary.hpp"

extern char** environ;

namespace gdesp::tool {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr double refinement = 1.25;                                   // between pilots, at least
constexpr double plane_particles = 1500.0, space_particles = 3000.0;  // of water, in the coarsest pilot
constexpr std::size_t least_pilots = 3, most_pilots = 6;
constexpr double pilot_share = 0.1;  // of the budget, for the finest pilot

/// Runs a program that lies beside this one; returns what it writes to stdout. Throws Error with its exit code's kind.
std::string output_of(const std::string& program, const std::vector<std::string>& arguments) {
  const std::string path = (fs::read_symlink("/proc/self/exe").parent_path() / program).string();
  std::vector<std::string> words{path};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) throw Error(ErrorKind::resource, std::string("pipe: ") + std::strerror(errno));
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  pid_t child = 0;
  const int failed = ::posix_spawn(&child, path.c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(ends[1]);
  if (failed != 0) {
    ::close(ends[0]);
    throw Error(ErrorKind::resource, path + ": cannot be started: " + std::strerror(failed));
  }
  std::string text;
  char block[4096];
  for (ssize_t n; (n = ::read(ends[0], block, sizeof block)) != 0;) {
    if (n > 0)
      text.append(block, static_cast<std::size_t>(n));
    else if (errno != EINTR)
      break;
  }
  ::close(ends[0]);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {}
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 5;
  if (code == 0) return text;
  throw Error(code == 2 || code == 3 ? ErrorKind::input : (code == 4 ? ErrorKind::numerical : ErrorKind::resource),
              program + " failed for the target with exit code " + std::to_string(code) + "; its message is above");
}

/// A scene at another dp: grains keep their ratio to dp, drag keeps the grains that the scene has.
std::vector<std::string> set_dp(const Scene& scene, const std::vector<Override>& overrides, double dp) {
  std::vector<std::string> words;
  const auto set = [&](const std::string& key, const std::string& value) {
    words.push_back("--set");
    words.push_back(key + "=" + value);
  };
  for (const Override& o : overrides) set(o.key, o.value);
  set("resolution.dp", number_text(dp, 12));
  for (std::size_t k = 0; k < scene.slides.size(); ++k) {
    const Slide& slide = scene.slides[k];
    if (slide.kind != "granular" || slide.diameter <= 0.0) continue;
    const std::string name = "slide." + std::to_string(k) + ".";
    set(name + "diameter", number_text(slide.diameter * dp / scene.dp, 12));
    if (slide.real_diameter <= 0.0) set(name + "real_diameter", number_text(slide.diameter, 12));
  }
  return words;
}

ordered_json build(const RunOptions& o, const Scene& scene, double dp, const std::string& path) {
  std::vector<std::string> words{o.case_path, "-o", path, "--quiet", "--force"};
  for (const std::string& word : set_dp(scene, o.overrides, dp)) words.push_back(word);
  std::istringstream lines(output_of("mesh2particles", words));
  for (std::string line; std::getline(lines, line);) {
    ordered_json record = ordered_json::parse(line, nullptr, false);
    if (record.is_object() && record.value("record", "") == "case") return record;
  }
  throw Error(ErrorKind::input, "mesh2particles made no case of " + o.case_path);
}

/// m: the highest value of the column run_up[m].
double highest_run_up(const std::string& run_folder) {
  std::istringstream lines(output_of("surge-analyze", {"runup", run_folder, "--quiet"}));
  std::string line, cell;
  std::getline(lines, line);
  std::size_t column = 0, at = 0;
  std::istringstream header(line);
  for (; std::getline(header, cell, '\t'); ++at)
    if (cell == "run_up[m]") column = at;
  double highest = 0.0;
  while (std::getline(lines, line)) {
    std::istringstream row(line);
    for (std::size_t k = 0; k <= column && std::getline(row, cell, '\t'); ++k)
      if (k == column) highest = std::max(highest, std::strtod(cell.c_str(), nullptr));
  }
  return highest;
}

/// What a run that has ended says about itself.
Pilot pilot_of(const std::string& run_folder, double dp) {
  const ordered_json run = read_run_json(run_folder);
  return {dp, highest_run_up(run_folder), run.value("wall_seconds", 0.0), run.value("processor_seconds", 0.0),
          run["scene"].value("wall_share", 0.0)};
}

/// The spacing at which the scene has as many water particles as the coarsest pilot should.
double first_dp(const RunOptions& o, const Scene& scene, const std::string& folder) {
  const double pilot_particles = scene.dimensions == 2 ? plane_particles : space_particles;
  double dp = 4.0 * scene.dp;
  for (int attempt = 0; attempt < 4; ++attempt) {
    const double n = build(o, scene, dp, folder + "/first.case").value("fluid", 0.0);
    if (n > 0.5 * pilot_particles && n < 2.0 * pilot_particles) return dp;
    dp *= n > 0.0 ? std::pow(n / pilot_particles, 1.0 / scene.dimensions) : 0.5;
  }
  return dp;
}

Pilot run_pilot(const RunOptions& o, const Scene& scene, double dp, const std::string& folder) {
  const std::string name = folder + "/pilot";
  build(o, scene, dp, name + ".case");
  std::vector<std::string> words{name + ".case", "-o",        name + ".run",
                                 "--force",      "--quiet",   "--device",
                                 o.device,       "--threads", std::to_string(o.threads)};
  if (o.t_end) words.insert(words.end(), {"--t-end", number_text(*o.t_end, 12)});
  output_of("gdesp-run", words);
  const Pilot pilot = pilot_of(name + ".run", dp);
  cli::info("pilot: dp " + number_text(dp, 3) + " m, run-up " + number_text(pilot.run_up) + " m, " +
            duration_text(pilot.seconds));
  return pilot;
}

std::vector<Pilot> run_pilots(const RunOptions& o, const Scene& scene, const Targets& targets,
                              const std::string& folder) {
  std::vector<Pilot> pilots;
  const double unit = common_length(scene);
  double dp = coarser_part(unit, first_dp(o, scene, folder));
  if (dp > coarsest_dp(scene)) dp = finer_part(unit, coarsest_dp(scene));
  while (pilots.size() < most_pilots && !cli::interrupted()) {
    pilots.push_back(run_pilot(o, scene, dp, folder));
    dp = finer_part(unit, dp / refinement);
    const bool dear =
        targets.budget <= 0.0 || predicted_seconds(pilots, dp, scene.dimensions) > pilot_share * targets.budget;
    if (pilots.size() >= least_pilots && dear) break;
  }
  return pilots;
}

/// How the cost of a particle grows from the pilot's number of particles to that of a run so much finer.
double growth_up_to(const RunOptions& o, const std::string& case_path, double finer) {
  Case pilot = read_case(case_path, {});
  const SimulationInput input = case_to_input(pilot);
  const auto few = static_cast<double>(input.fluid.position.size());
  const double more = std::pow(finer, input.fluid_parameters.dimensions);
  if (!(few > 0.0) || more < 1.5) return 0.0;
  const double growth = growth_of_cost(input, resolve_device(o.device), few, more * few);
  return std::clamp(std::log(growth) / std::log(more), 0.0, 1.0);
}

ordered_json to_json(const Pilot& p) {
  return {{"dp", p.dp},
          {"run_up", p.run_up},
          {"wall_seconds", p.seconds},
          {"processor_seconds", p.processor_seconds},
          {"wall_share", p.wall_share},
          {"growth", p.growth}};
}

std::string percent(double share) { return number_text(100.0 * share, 3) + " %"; }

/// Says what was reached, and writes it to target.json in the run folder.
void tell_reached(const RunOptions& o, const Targets& targets, std::vector<Pilot> runs, const Choice& choice,
                  double common_length) {
  const Pilot reached = pilot_of(o.run_folder, choice.dp);
  ordered_json record{{"accuracy", targets.accuracy},
                      {"budget", targets.budget},
                      {"reason", choice.reason},
                      {"dp", choice.dp},
                      {"common_length", common_length},
                      {"predicted_seconds", choice.seconds},
                      {"predicted_processor_seconds", choice.processor_seconds},
                      {"predicted_error", choice.error}};
  for (const Pilot& p : runs) record["pilots"].push_back(to_json(p));
  runs.push_back(reached);
  const RunUpFit fit = fit_run_up(runs);
  const double error = std::abs(reached.run_up - fit.limit) / fit.limit;
  record["reached"] = to_json(reached);
  record["reached_error"] = error;
  record["limit"] = fit.limit;
  write_text_file(o.run_folder + "/target.json", record.dump(1) + "\n");
  cli::info("target: run-up " + number_text(reached.run_up) + " m; with dp to 0 " + number_text(fit.limit) +
            " m, so off by " + percent(error) + " (promised " + percent(choice.error) + "); " +
            duration_text(reached.seconds) + " (promised " + duration_text(choice.seconds) + ")");
}

}  // namespace

int run_to_target(const RunOptions& o) {
  const Targets targets{o.accuracy, o.budget};
  const Scene scene = read_scene(o.case_path, o.overrides);
  const std::string folder = o.run_folder + ".pilots";
  fs::create_directories(folder);
  std::vector<Pilot> pilots = run_pilots(o, scene, targets, folder);
  if (cli::interrupted()) return 130;
  if (!(fit_run_up(pilots).limit > 0.0))
    throw Error(
        ErrorKind::input,
        o.case_path + ": the pilot runs have no run-up to aim at (surge-analyze runup); give resolution.dp instead");
  const double unit = common_length(scene);
  pilots.back().growth =
      growth_up_to(o, folder + "/pilot.case", pilots.back().dp / choose_dp(pilots, targets, scene.dimensions, unit).dp);
  const Choice choice = choose_dp(pilots, targets, scene.dimensions, unit);
  cli::info("chosen: dp " + number_text(choice.dp, 3) + " m, preset " + scene.numerics.preset + ": " + choice.reason +
            "; about " + duration_text(choice.seconds) + ", run-up within about " + percent(choice.error));
  fs::remove_all(folder);
  const std::string case_path =
      (fs::path(o.run_folder).parent_path() / fs::path(o.run_folder).stem()).string() + ".case";
  build(o, scene, choice.dp, case_path);
  RunOptions run = o;
  run.case_path = case_path;
  run.overrides.clear();
  const int code = run_case(run);
  if (code == 0) tell_reached(o, targets, pilots, choice, unit);
  return code;
}

}  // namespace gdesp::tool
