// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.hpp"

#include <malloc.h>
#include <unistd.h>

#include <charconv>
#include <iostream>

#include "analysis/plot.hpp"
#include "core/error.hpp"

namespace gdesp::tool {
namespace {

/// The reader of our stdout has gone. No std::exception, so that nothing on the way catches it.
struct ReaderGone {};

}  // namespace

po::options_description input_options() {
  po::options_description o("Input");
  o.add_options()("input", po::value<std::vector<std::string>>()->value_name("RUN")->default_value({}, ""),
                  "run folder, frame files of this or another program, or - for records on standard input");
  o.add_options()("case", po::value<std::string>()->value_name("FOLDER"),
                  "case of the run, where the run does not say");
  o.add_options()("field", po::value<std::vector<std::string>>()->value_name("OURS=THEIRS"),
                  "name of a field in another program's files, e.g. velocity=Vel; may be repeated");
  o.add_options()("dp", po::value<double>()->value_name("M"), "particle spacing, where the files do not carry it");
  o.add_options()("dimensions", po::value<int>()->value_name("2|3"),
                  "for files without a case (default: from the data)");
  o.add_options()("still-water", po::value<double>()->value_name("M"),
                  "still-water elevation, scene coordinates (default: the case's)");
  o.add_options()("from", po::value<double>()->value_name("S"), "first time");
  o.add_options()("until", po::value<double>()->value_name("S"), "last time");
  o.add_options()("every", po::value<int>()->value_name("N")->default_value(1), "take every N-th frame");
  o.add_options()("frame-interval", po::value<double>()->value_name("S")->default_value(0.0, "0"),
                  "time between several frame files that carry no time");
  return o;
}

po::options_description output_options() {
  po::options_description o("Output");
  o.add_options()("format", po::value<std::string>()->value_name("tsv|csv|json")->default_value("tsv"),
                  "of the table on stdout");
  o.add_options()("plot", po::value<std::string>()->value_name("FILE"), "draw the result: FILE.svg, .png or .pdf");
  return o;
}

CommandLine::CommandLine(const std::string& command, const po::options_description& own, Inputs inputs)
    : name(command) {
  all.add(own);
  if (inputs == Inputs::frames) all.add(input_options());
  all.add(output_options()).add(cli::common_options());
}

bool CommandLine::parse(const std::vector<std::string>& arguments, const std::string& definition,
                        const std::string& example, const char* positional) {
  po::positional_options_description words;
  words.add(positional, -1);
  vm = cli::parse(arguments, all, words);
  const std::string word = all.find(positional, false).semantic()->name();
  const std::string what = " " + word.substr(0, word.find(" (=")) + (word == "TABLE" ? "..." : "") + " [options]\n";
  if (cli::answer_help_or_version(vm, "surge-analyze " + name + what + definition, all, "Example: " + example + "\n")) {
    return false;
  }
  cli::apply_common(vm);
  if (has("plot")) analysis::check_plot_path(get<std::string>("plot"));
  analysis::parse_table_format(get<std::string>("format"));
  return true;
}

analysis::SourceOptions source_options(const CommandLine& line) {
  analysis::SourceOptions s;
  s.inputs = line.get<std::vector<std::string>>("input");
  if (line.has("field")) {
    for (const std::string& text : line.get<std::vector<std::string>>("field")) {
      const auto equals = text.find('=');
      if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
        throw Error(ErrorKind::usage, "--field " + text + ": valid is OURS=THEIRS, e.g. velocity=Vel");
      }
      s.mapping.push_back({text.substr(0, equals), text.substr(equals + 1)});
    }
  }
  if (line.has("dp")) {
    s.dp = line.get<double>("dp");
    if (!(s.dp > 0.0))
      throw Error(ErrorKind::usage, "--dp " + analysis::format_number(s.dp) + ": a length above 0 m is needed");
  }
  if (line.has("dimensions")) {
    s.dimensions = line.get<int>("dimensions");
    if (s.dimensions != 2 && s.dimensions != 3) throw Error(ErrorKind::usage, "--dimensions: valid are 2 and 3");
  }
  if (line.has("case")) s.case_path = line.get<std::string>("case");
  if (line.has("still-water")) s.still_water = line.get<double>("still-water");
  if (line.has("from")) s.from = line.get<double>("from");
  if (line.has("until")) s.until = line.get<double>("until");
  s.every = line.get<int>("every");
  if (s.every < 1) throw Error(ErrorKind::usage, "--every " + std::to_string(s.every) + ": 1 or more is needed");
  s.frame_interval = line.get<double>("frame-interval");
  s.next_record = [number = 0]() mutable { return cli::read_record(std::cin, number); };
  return s;
}

analysis::TableWriter::Sink stdout_sink() {
  return [](const std::string& text) {
    std::cout << text << std::flush;
    if (!std::cout) throw ReaderGone{};
  };
}

std::function<int(const std::vector<std::string>&)> until_reader_leaves(
    std::function<int(const std::vector<std::string>&)> body) {
  return [body = std::move(body)](const std::vector<std::string>& arguments) {
    try {
      return body(arguments);
    } catch (const ReaderGone&) { return 0; }
  };
}

int run_measurement(const CommandLine& line, analysis::Measurement& measurement) {
  analysis::SourceOptions options = source_options(line);
  const bool live = !options.inputs.empty() && options.inputs[0] == "-";
  cli::install_signal_handlers();
  analysis::FrameSource source(std::move(options));
  analysis::TableWriter writer(stdout_sink(), analysis::parse_table_format(line.get<std::string>("format")),
                               measurement.begin(source.info()));
  {
    std::optional<cli::Progress> progress;
    if (!live && source.expected() > 1 && ::isatty(STDERR_FILENO)) progress.emplace(line.name);
    analysis::run_measurements(
        source, {&measurement}, {[&](const std::vector<analysis::Cell>& cells) { writer.row(cells); }},
        [&](double fraction, double time) {
          ::malloc_trim(0);  // the next frame does not lie in the holes of this one
          if (progress) progress->update(fraction, "t = " + analysis::format_number(time) + " s");
        },
        [] { return cli::interrupted(); });
  }
  writer.finish();
  if (!measurement.summary().empty()) cli::info(measurement.summary());
  if (line.has("plot")) {
    analysis::write_figure(measurement.figure(), line.get<std::string>("plot"));
    cli::info("plot: " + line.get<std::string>("plot"));
  }
  if (cli::interrupted()) return 130;
  if (source.cut_short()) {
    cli::warning(
        "the records ended without the producer's last word (done, interrupted or failed): it was killed; the table "
        "ends with its last frame");
    return static_cast<int>(ErrorKind::numerical);
  }
  if (!source.failed()) return 0;
  cli::warning("the run failed" + (source.failure().empty() ? "" : ": " + source.failure()) +
               "; the table ends with its last frame");
  return static_cast<int>(ErrorKind::numerical);
}

std::vector<double> parse_numbers(const std::string& option, const std::string& text) {
  std::vector<double> numbers;
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t end = std::min(text.find(',', start), text.size());
    double value = 0.0;
    const auto [stopped, problem] = std::from_chars(text.data() + start, text.data() + end, value);
    if (problem != std::errc() || stopped != text.data() + end) {
      throw Error(ErrorKind::usage, option + " " + text + ": numbers with commas between are needed");
    }
    numbers.push_back(value);
    start = end + 1;
  }
  return numbers;
}

Section parse_line(const std::string& option, const std::string& text) {
  const std::vector<double> n = parse_numbers(option, text);
  if (n.size() != 4) throw Error(ErrorKind::usage, option + " " + text + ": x1,y1,x2,y2 is needed");
  return {"the line", {n[0], n[1]}, {n[2], n[3]}};
}

}  // namespace gdesp::tool
