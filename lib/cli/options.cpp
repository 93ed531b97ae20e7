// SPDX-License-Identifier: GPL-3.0-or-later
// Options on Boost.Program_options.
#include <iostream>
#include <sstream>

#include "cli/terminal.hpp"
#include "core/text.hpp"
#include "core/version.hpp"

namespace gdesp::cli {

namespace po = boost::program_options;

namespace {

std::function<std::string()> version_details;

std::vector<std::string> long_names(const po::options_description& options) {
  std::vector<std::string> names;
  for (const auto& option : options.options()) names.push_back("--" + option->long_name());
  return names;
}

std::string version_text() {
  std::string text = terminal::tool_name() + " " + gdesp::version + " (" + gdesp::commit + ")\nbuilt by " +
                     gdesp::compiler + ", " + gdesp::build_type + "\n";
  if (version_details) text += version_details();
  if (text.back() != '\n') text += '\n';
  return text;
}

}  // namespace

po::options_description common_options() {
  po::options_description common("General");
  common.add_options()("help,h", "print this help and end");
  common.add_options()("version", "print version, build, back ends and devices, and end");
  common.add_options()("quiet,q", "only warnings and errors on stderr");
  common.add_options()("verbose,v", "more on stderr");
  common.add_options()("log-format", po::value<std::string>()->value_name("text|json")->default_value("text"),
                       "format of what goes to stderr");
  return common;
}

po::variables_map parse(const std::vector<std::string>& arguments, const po::options_description& options,
                        const po::positional_options_description& positional) {
  namespace style = po::command_line_style;
  po::variables_map vm;
  try {
    const int chosen = style::unix_style & ~style::allow_guessing;
    po::store(po::command_line_parser(arguments).options(options).positional(positional).style(chosen).run(), vm);
    if (!vm.count("help") && !vm.count("version")) po::notify(vm);
  } catch (const po::unknown_option& error) {
    const std::string name = error.get_option_name();
    const std::string near = gdesp::did_you_mean(name, long_names(options));
    throw Error(ErrorKind::usage,
                "unknown option " + name + (near.empty() ? "" : "; did you mean " + near + "?") + " (see --help)");
  } catch (const po::too_many_positional_options_error&) {
    throw Error(ErrorKind::usage, "too many arguments (see --help)");
  } catch (const po::error& error) { throw Error(ErrorKind::usage, std::string(error.what()) + " (see --help)"); }
  return vm;
}

void apply_common(const po::variables_map& vm) {
  const bool quiet = vm.count("quiet") > 0, verbose = vm.count("verbose") > 0;
  if (quiet && verbose) throw Error(ErrorKind::usage, "--quiet and --verbose contradict each other");
  const std::string format = vm.count("log-format") ? vm["log-format"].as<std::string>() : "text";
  if (format != "text" && format != "json")
    throw Error(ErrorKind::usage, "--log-format: found \"" + format + "\", expected text or json");
  set_verbosity(quiet ? Verbosity::quiet : (verbose ? Verbosity::verbose : Verbosity::normal), format == "json");
}

void set_version_details(std::function<std::string()> details) { version_details = std::move(details); }

bool answer_help_or_version(const po::variables_map& vm, const std::string& usage,
                            const po::options_description& options, const std::string& example) {
  if (vm.count("version")) {
    terminal::write_stdout(version_text());
    return true;
  }
  if (!vm.count("help")) return false;
  std::ostringstream text;
  text << usage << "\n" << options << "\n" << example;
  if (!example.empty() && example.back() != '\n') text << '\n';
  terminal::write_stdout(text.str());
  return true;
}

Override parse_override(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw Error(ErrorKind::usage, "--set " + text + ": expected KEY=VALUE, such as resolution.dp=5");
  const auto trimmed = [](const std::string& part) {
    const std::size_t first = part.find_first_not_of(" \t"), last = part.find_last_not_of(" \t");
    return first == std::string::npos ? std::string() : part.substr(first, last - first + 1);
  };
  return {trimmed(text.substr(0, equals)), trimmed(text.substr(equals + 1))};
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates) {
  return gdesp::did_you_mean(word, candidates);
}

}  // namespace gdesp::cli
