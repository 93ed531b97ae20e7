// SPDX-License-Identifier: GPL-3.0-or-later
// What the three tools share: options on Boost.Program_options with did-you-mean, exit codes, messages, the
// progress bar, and NDJSON records between tools (docs/formats/records.md).
#pragma once

#include <boost/program_options.hpp>
#include <functional>
#include <iosfwd>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "scene/scene.hpp"

namespace gdesp::cli {

/// People's side (stderr). Text or, with --log-format json, one object a line.
enum class Verbosity { quiet, normal, verbose };
void set_verbosity(Verbosity verbosity, bool json);
void info(const std::string& message);
void detail(const std::string& message);  ///< only with --verbose
void warning(const std::string& message);
void error(const std::string& message);

/// Percent, simulated time, dt, ETA, score; drawn only when stderr is a terminal (else a line now and then).
class Progress {
 public:
  explicit Progress(std::string what);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  void update(double fraction, const std::string& note = {});
  void done(const std::string& note = {});

 private:
  struct State;
  State* state_;
};

/// Machines' side (stdout).
bool stdout_is_terminal();
void write_record(const nlohmann::ordered_json& record);  ///< one line, flushed; a closed pipe ends the tool quietly
/// Next record from a stream; nullopt at its end. A line that is no object is an input error that names its number.
std::optional<nlohmann::ordered_json> read_record(std::istream& in, int& line_number);

/// Options every tool has: --help --version --quiet --verbose --log-format.
boost::program_options::options_description common_options();
/// Parses; on an unknown option throws Error(usage) with "did you mean". With --help or --version nothing is required.
boost::program_options::variables_map parse(const std::vector<std::string>& arguments,
                                            const boost::program_options::options_description& options,
                                            const boost::program_options::positional_options_description& positional);
void apply_common(const boost::program_options::variables_map& vm);
/// Extra lines of --version (back ends built, devices seen), made when asked.
void set_version_details(std::function<std::string()> details);
/// Answers --help and --version on stdout and returns true when one of them was given; the tool then ends with 0.
/// `usage`: the lines above the options; `example`: those below.
bool answer_help_or_version(const boost::program_options::variables_map& vm, const std::string& usage,
                            const boost::program_options::options_description& options, const std::string& example);
/// "key=value" from --set.
Override parse_override(const std::string& text);
/// The nearest of the candidates within a sensible edit distance, or "".
std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates);

/// Runs the tool's body: maps Error to its exit code and a message, bad_alloc to 5, a broken pipe to a quiet end.
int run_tool(const char* name, int argc, char** argv, const std::function<int(const std::vector<std::string>&)>& body);

/// Set by SIGINT / SIGTERM once install_signal_handlers() was called; tools poll it.
void install_signal_handlers();
bool interrupted();

}  // namespace gdesp::cli
