// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>

#include "core/version.hpp"
#include "exec/backend.hpp"
#include "io/frame.hpp"
#include "run_files.hpp"
#include "target.hpp"

namespace gdesp::tool {
namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;

const char* const usage =
    "gdesp-run CASE [-o RUN] [options]\n"
    "Simulates a case that mesh2particles has made: grains (discrete elements) and water (smoothed particles).\n"
    "CASE is a folder, or - for the record of mesh2particles on standard input. Frames, log and checkpoints go into\n"
    "the folder RUN (default: the case's name with .run, in the current folder); a record of each frame goes to "
    "stdout.\n";

const char* const example =
    "Examples:\n"
    "  gdesp-run lake.case -o lake.run --set numerics.cfl=0.4\n"
    "  mesh2particles lake.toml -o lake.case | gdesp-run - -o lake.run | surge-analyze runup - > runup.tsv\n"
    "  gdesp-run lake.case -o lake.run --resume      after an interruption\n"
    "  gdesp-run lake.toml -o lake.run --accuracy 5% --budget 30min\n"
    "Exit codes: 0 done; 2 usage; 3 bad input; 4 numerical failure; 5 device or resource; 130 interrupted.\n";

po::options_description own_options() {
  po::options_description o("Run");
  o.add_options()("case", po::value<std::string>()->value_name("CASE"), "case folder, or -");
  o.add_options()("output,o", po::value<std::string>()->value_name("RUN"), "folder of the run");
  o.add_options()("device", po::value<std::string>()->value_name("auto|cpu|cuda|cuda:N")->default_value("auto"),
                  "auto takes the GPU when there is one");
  o.add_options()("threads", po::value<int>()->value_name("N")->default_value(0, "OMP_NUM_THREADS, else all cores"),
                  "threads of the processor");
  o.add_options()("t-end", po::value<double>()->value_name("S"), "simulated time (default: time.end of the scene)");
  o.add_options()("preset", po::value<std::string>()->value_name("NAME"), "numerics.preset: accurate or paper");
  o.add_options()("set", po::value<std::vector<std::string>>()->value_name("KEY=VALUE"),
                  "changes a key of the scene that needs no new particles; may be repeated");
  o.add_options()("accuracy", po::value<std::string>()->value_name("SHARE"),
                  "CASE is a scene: pilot runs choose the dp that gives the run-up this well, such as 5%");
  o.add_options()("budget", po::value<std::string>()->value_name("TIME"),
                  "CASE is a scene: the finest dp that this wall time pays for, such as 10min; both: whichever binds");
  o.add_options()("resume", "goes on from the newest sound checkpoint in RUN");
  o.add_options()("checkpoint-every", po::value<double>()->value_name("S")->default_value(0.0, "600"),
                  "wall time between checkpoints; an interrupted run always writes one");
  o.add_options()("log-every", po::value<int>()->value_name("STEPS")->default_value(steps_between_diagnostics),
                  "steps between lines of log.ndjson, 1 to 100: fewer show short bursts of energy");
  o.add_options()("explain",
                  "prints models, counts, limits, memory and expected wall time; runs nothing, writes nothing");
  o.add_options()("profile", "measures the loops and prints their shares");
  o.add_options()("force", "replaces an earlier run in RUN");
  return o;
}

std::string version_details() {
  std::string text = std::string("back ends: cpu (OpenMP)") +
                     (exec::cuda_built() ? std::string(", cuda (nvcc ") + cuda_compiler + ")" : "") + "\n";
  if (!exec::cuda_built()) return text + "devices: cpu only (built without CUDA)\n";
  const auto devices = exec::cuda_devices();
  if (devices.empty()) return text + "devices: cpu only (no CUDA device seen)\n";
  for (const auto& d : devices) {
    char line[160];
    std::snprintf(line, sizeof line, "device cuda:%d: %s, %.1f GiB, compute capability %d.%d\n", d.number,
                  d.name.c_str(), d.memory_bytes / 1073741824.0, d.compute_capability / 10, d.compute_capability % 10);
    text += line;
  }
  return text;
}

double positive_seconds(const po::variables_map& vm, const char* name) {
  const double value = vm[name].as<double>();
  if (std::isfinite(value) && value > 0.0) return value;
  throw Error(ErrorKind::usage,
              std::string("--") + name + " " + std::to_string(value) + ": a time above 0 s is needed");
}

RunOptions collect(const po::variables_map& vm) {
  RunOptions o;
  if (vm.count("case")) o.case_path = vm["case"].as<std::string>();
  if (vm.count("output")) o.run_folder = vm["output"].as<std::string>();
  o.device = vm["device"].as<std::string>();
  o.threads = vm["threads"].as<int>();
  if (o.threads < 0)
    throw Error(ErrorKind::usage,
                "--threads " + std::to_string(o.threads) + ": 0 (OMP_NUM_THREADS, else all cores) or more is needed");
  if (vm.count("t-end")) o.t_end = positive_seconds(vm, "t-end");
  if (vm.count("preset")) o.overrides.push_back({"numerics.preset", vm["preset"].as<std::string>()});
  if (vm.count("set"))
    for (const std::string& text : vm["set"].as<std::vector<std::string>>())
      o.overrides.push_back(cli::parse_override(text));
  if (vm.count("accuracy")) o.accuracy = parse_accuracy(vm["accuracy"].as<std::string>());
  if (vm.count("budget")) o.budget = parse_duration(vm["budget"].as<std::string>());
  o.checkpoint_every = vm["checkpoint-every"].defaulted() ? 600.0 : positive_seconds(vm, "checkpoint-every");
  if (!vm["log-every"].defaulted()) {
    o.log_every = vm["log-every"].as<int>();
    if (o.log_every < 1 || o.log_every > steps_between_diagnostics)
      throw Error(ErrorKind::usage, "--log-every " + std::to_string(o.log_every) + ": steps, 1 to 100, are needed");
  }
  o.resume = vm.count("resume") > 0;
  o.explain = vm.count("explain") > 0;
  o.profile = vm.count("profile") > 0;
  o.force = vm.count("force") > 0;
  if (o.resume && o.force)
    throw Error(ErrorKind::usage, "--resume and --force contradict each other: go on, or start anew?");
  if ((o.accuracy > 0.0 || o.budget > 0.0) && (o.resume || o.explain))
    throw Error(ErrorKind::usage,
                "--accuracy and --budget choose a case to run: neither --resume nor --explain goes with them");
  return o;
}

/// Reads records up to the first of a case; the others go on to whoever reads our stdout.
std::string case_from_stdin() {
  int line_number = 0;
  while (auto record = cli::read_record(std::cin, line_number)) {
    const auto kind = record->find("record"), path = record->find("path");
    const bool is_case = kind != record->end() && kind->is_string() && kind->get<std::string>() == "case";
    if (!is_case) {
      cli::write_record(*record);
      continue;
    }
    if (path != record->end() && path->is_string() && !path->get<std::string>().empty())
      return path->get<std::string>();
    throw Error(ErrorKind::input,
                "standard input, line " + std::to_string(line_number) + ": a case record without \"path\"");
  }
  if (cli::interrupted()) return {};
  throw Error(ErrorKind::input,
              "standard input ended without a case record (mesh2particles writes one when it has succeeded)");
}

std::string absolute(const std::string& path) {
  std::string text = fs::absolute(path).lexically_normal().string();
  while (text.size() > 1 && text.back() == '/') text.pop_back();
  return text;
}

/// From the run.json of the run that goes on.
void take_over(RunOptions& options, const nlohmann::ordered_json& earlier) {
  if (!earlier.is_object()) return;
  const auto number = [&](const char* key) -> std::optional<double> {
    const auto found = earlier.find(key);
    if (found == earlier.end() || !found->is_number() || !(found->get<double>() > 0.0)) return std::nullopt;
    return found->get<double>();
  };
  if (!options.t_end) options.t_end = number("t_end");
  options.output_interval = number("output_interval");
  if (const auto steps = number("log_every"); steps && options.log_every == 0)
    options.log_every = static_cast<int>(std::clamp(*steps, 1.0, static_cast<double>(steps_between_diagnostics)));
  const auto overrides = earlier.find("overrides");
  if (!options.overrides.empty() || overrides == earlier.end() || !overrides->is_array()) return;
  for (const auto& text : *overrides)
    if (text.is_string()) options.overrides.push_back(cli::parse_override(text.get<std::string>()));
}

}  // namespace

std::optional<RunOptions> parse_options(const std::vector<std::string>& arguments) {
  cli::set_version_details(version_details);
  po::options_description all;
  all.add(own_options()).add(cli::common_options());
  po::positional_options_description positional;
  positional.add("case", 1);
  const po::variables_map vm = cli::parse(arguments, all, positional);
  if (cli::answer_help_or_version(vm, usage, all, example)) return std::nullopt;
  cli::apply_common(vm);
  RunOptions options = collect(vm);
  options.arguments = arguments;
  if (options.case_path.empty() && !(options.resume && !options.run_folder.empty()))
    throw Error(ErrorKind::usage, "no case given: gdesp-run CASE [-o RUN], or - for standard input (see --help)");
  return options;
}

void resolve_paths(RunOptions& options) {
  if (options.case_path == "-") {
    options.case_path = case_from_stdin();
    if (cli::interrupted()) return;
  }
  if (options.case_path.empty()) options.case_path = run_case_path(options.run_folder);
  options.case_path = absolute(options.case_path);
  if (options.run_folder.empty()) options.run_folder = fs::path(options.case_path).stem().string() + ".run";
  options.run_folder = absolute(options.run_folder);
  if (options.resume) take_over(options, read_run_json(options.run_folder));
  if (options.log_every == 0) options.log_every = steps_between_diagnostics;
}

}  // namespace gdesp::tool
