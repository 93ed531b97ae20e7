// SPDX-License-Identifier: GPL-3.0-or-later
// What the commands share: where frames come from, how tables and plots go out.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "analysis/frame_source.hpp"
#include "analysis/measurement.hpp"
#include "cli/cli.hpp"

namespace gdesp::tool {

namespace po = boost::program_options;

/// --field --dp --dimensions --case --still-water --from --until --every --frame-interval and the inputs.
po::options_description input_options();
/// --format and --plot.
po::options_description output_options();

/// Input, output and common options in one, with those of the command first.
struct CommandLine {
  enum class Inputs { frames, own };  ///< whether the command reads frames, or names its inputs itself
  CommandLine(const std::string& name, const po::options_description& own, Inputs inputs = Inputs::frames);
  /// False when --help or --version has been answered. `definition` explains what is measured; `positional`: the
  /// option that takes the words without a name.
  bool parse(const std::vector<std::string>& arguments, const std::string& definition, const std::string& example,
             const char* positional = "input");

  template <class T>
  T get(const char* key) const {
    return vm[key].as<T>();
  }
  bool has(const char* key) const { return vm.count(key) > 0; }

  std::string name;
  po::options_description all;
  po::variables_map vm;
};

analysis::SourceOptions source_options(const CommandLine& line);

/// stdout for a TableWriter; a reader that has gone ends the tool quietly.
analysis::TableWriter::Sink stdout_sink();
/// Wraps a tool's body so that a reader that has gone ends it with 0.
std::function<int(const std::vector<std::string>&)> until_reader_leaves(
    std::function<int(const std::vector<std::string>&)> body);

/// Reads the frames of the command line through one measurement, prints its table, draws its plot, says its
/// summary. Returns the exit code: 0; 4 when the producer failed; 130 when interrupted.
int run_measurement(const CommandLine& line, analysis::Measurement& measurement);

/// "a,b,c" to numbers; throws Error(usage) naming the option.
std::vector<double> parse_numbers(const std::string& option, const std::string& text);
/// "x1,y1,x2,y2" to a line in scene coordinates.
Section parse_line(const std::string& option, const std::string& text);

}  // namespace gdesp::tool
