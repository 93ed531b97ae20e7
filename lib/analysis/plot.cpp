// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/plot.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "analysis/table.hpp"
#include "core/error.hpp"

extern char** environ;

namespace gdesp::analysis {
namespace {

namespace fs = std::filesystem;

// Okabe & Ito 2008, "Color Universal Design": blue, vermillion, green, orange, sky, purple, black, grey.
const char* const palette[] = {"#0072B2", "#D55E00", "#009E73", "#E69F00", "#56B4E9", "#CC79A7", "#000000", "#888888"};
constexpr int colours = 8;
const int marks[] = {7, 5, 9, 13, 11, 6, 4, 8};
const char* const dashes[] = {"1", "'-'", "'.-'", "'-..'", "'.'", "'- .'", "1", "'-'"};

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '\n')
      out += "\\n";
    else if (c == '"' || c == '\\')
      (out += '\\') += c;
    else
      out += c;
  }
  return out + '"';
}

std::string extension(const std::string& path) {
  std::string e = fs::path(path).extension().string();
  std::transform(e.begin(), e.end(), e.begin(), [](unsigned char c) { return std::tolower(c); });
  return e;
}

std::string terminal(const std::string& kind, double width_mm, double height_mm) {
  std::ostringstream out;
  const double width_in = width_mm / 25.4, height_in = height_mm / 25.4;
  if (kind == ".svg") {
    out << "set terminal svg enhanced background '#ffffff' size " << std::lround(width_in * 96) << ","
        << std::lround(height_in * 96) << " font 'Helvetica,Arial,DejaVu Sans,sans-serif,13' linewidth 1.1\n";
  } else if (kind == ".png") {
    out << "set terminal pngcairo enhanced size " << std::lround(width_in * 200) << "," << std::lround(height_in * 200)
        << " font 'DejaVu Sans,9' fontscale 2.1 linewidth 2.2 pointscale 1.6\n";
  } else {
    out << "set terminal pdfcairo enhanced size " << width_in << "in," << height_in
        << "in font 'DejaVu Sans,9' linewidth 1.2\n";
  }
  return out.str();
}

void write_common(std::ostream& out) {
  out << "set encoding utf8\nset datafile missing 'nan'\n"
         "set border 3 lw 0.8 lc '#333333'\nset tics nomirror out scale 0.6 textcolor '#222222'\n"
         "set grid lw 0.5 lc '#d0d0d0' dt 1\nset key spacing 1.15 samplen 2.2 Left reverse\nset autoscale xfix\n"
         "set style fill transparent solid 0.25 noborder\n"
         "set palette defined (0 '#440154', 0.25 '#3b528b', 0.5 '#21918c', 0.75 '#5ec962', 1 '#fde725')\n";
}

void write_block(std::ostream& out, const std::string& name, const Series& s) {
  out << "$" << name << " << EOD\n";
  for (std::size_t k = 0; k < s.x.size(); ++k) {
    if (!std::isfinite(s.x[k]) || !std::isfinite(s.y[k])) {
      out << "\n";  // a gap
      continue;
    }
    out << format_number(s.x[k]) << ' ' << format_number(s.y[k]);
    if (k < s.low.size()) out << ' ' << format_number(s.low[k]) << ' ' << format_number(s.high[k]);
    if (k < s.name.size()) out << (s.low.empty() ? " 0 0 " : " ") << quoted(s.name[k]);
    out << '\n';
  }
  out << "EOD\n";
}

// `alone`: the only line of its panel, drawn solid whatever its colour.
std::string curve(const std::string& block, const Series& s, int number, bool alone = false) {
  const int c = (s.colour >= 0 ? s.colour : number) % colours;
  const char* const dash = alone ? "1" : dashes[c];
  std::ostringstream out;
  const std::string title = s.label.empty() ? " notitle" : " title " + quoted(s.label);
  const std::string colour = std::string(" lc rgb '") + palette[c] + "'";
  const std::string point = colour + " pt " + std::to_string(marks[c]) + " ps 0.7";
  switch (s.style) {
    case MarkStyle::line:
      out << "$" << block << " with lines lw 2" << colour << " dt " << dash;
      break;
    case MarkStyle::thin:
      out << "$" << block << " with lines lw 0.5" << colour << " dt 1";
      break;
    case MarkStyle::dashes:
      out << "$" << block << " with lines lw 1.2 dt '-'" << colour;
      break;
    case MarkStyle::points:
      if (s.low.empty())
        out << "$" << block << " with points" << point;
      else
        out << "$" << block << " using 1:2:3:4 with yerrorbars" << point;
      break;
    case MarkStyle::line_points:
      out << "$" << block << " with linespoints lw 1.5" << point << " dt " << dash;
      break;
    case MarkStyle::band:
      out << "$" << block << " using 1:3:4 with filledcurves" << colour;
      break;
    case MarkStyle::steps:
      out << "$" << block << " with fsteps lw 2" << colour << " dt " << dash;
      break;
    case MarkStyle::impulses:
      out << "$" << block << " with impulses lw 2" << colour;
      break;
  }
  out << title;
  if (!s.name.empty()) {
    out << ", $" << block
        << " using 1:2:5 with labels offset character 0.8,0.6 left font ',8' tc rgb '#333333' notitle";
  }
  return out.str();
}

struct Range {
  double low = INFINITY, high = -INFINITY;
};

Range range_of(const Panel& p, bool vertical) {
  Range r;
  const auto take = [&](double v) {
    if (std::isfinite(v)) r.low = std::min(r.low, v), r.high = std::max(r.high, v);
  };
  for (const Series& s : p.series) {
    for (const double v : vertical ? s.y : s.x) take(v);
    if (vertical)
      for (const double v : s.low) take(v);
    if (vertical)
      for (const double v : s.high) take(v);
  }
  return r;
}

// Over less than two decades powers of ten alone are too few: 1, 2 and 5 of each.
void write_log_ticks(std::ostream& out, const char* axis, const Range& r) {
  if (!(r.low > 0.0) || r.high > 100.0 * r.low) {
    out << "set " << axis << "tics auto\n";
    return;
  }
  out << "set " << axis << "tics (";
  const char* between = "";
  const int lowest = static_cast<int>(std::floor(std::log10(r.low))) - 1;
  for (int power = lowest; power < lowest + 6; ++power) {  // low to 100 low, and one more on either side
    const double decade = std::pow(10.0, power);
    if (decade > 10.0 * r.high) break;
    for (const double m : {1.0, 2.0, 5.0}) {
      out << between << '"' << format_number(m * decade) << "\" " << m * decade;
      between = ", ";
    }
  }
  out << ")\n";
}

// A constant or empty series would leave gnuplot without a range.
void write_range(std::ostream& out, const char* axis, const Range& r, bool log, bool reverse) {
  if (log && r.high > 0.0 && r.high > r.low && r.low > 0.0) {  // room for marks and names at both ends
    const double room = std::max(1.25, std::pow(r.high / r.low, 0.06));
    out << "set " << axis << "range [" << r.low / room << ":" << r.high * room << "]\n";
  } else if (r.low > r.high) {
    out << "set " << axis << "range [0:1]\n";
  } else if (r.high - r.low < 1e-12 * std::max(1.0, std::abs(r.high))) {
    const double pad = log ? 0.0 : std::max(0.5 * std::abs(r.high), 0.5e-3);
    if (log)
      out << "set " << axis << "range [" << 0.5 * r.low << ":" << 2.0 * r.high << "]\n";
    else
      out << "set " << axis << "range [" << r.low - pad << ":" << r.high + pad << "]\n";
  } else {
    out << "set " << axis << "range [*:*] " << (reverse ? "reverse" : "noreverse") << "\n";
  }
}

// Lines under a title; each is set small on its own.
std::string small_print(const std::string& note) {
  std::string text, line;
  std::istringstream lines(note);
  while (std::getline(lines, line)) text += "\n{/*0.82 " + line + "}";
  return text;
}

std::size_t legend_rows(const std::vector<Series>& series, std::size_t columns) {
  std::size_t named = 0;
  for (const Series& s : series) named += !s.label.empty();
  return (named + columns - 1) / columns;
}

struct Page {
  double width_mm;
  bool svg;
};

// The legend below the axis, columns as wide as its longest name needs. gnuplot measures text by its own guess, which is
// wide for SVG, and would rather break a row than pass the margin.
std::size_t legend_columns(const std::vector<Series>& series, const Page& page) {
  std::size_t longest = 1;
  for (const Series& s : series) longest = std::max(longest, s.label.size());
  const double column_mm =
      page.svg ? 22.0 + 2.9 * static_cast<double>(longest) : 18.0 + 1.9 * static_cast<double>(longest);
  return std::clamp<std::size_t>(static_cast<std::size_t>(page.width_mm / column_mm), 1, 4);
}

void write_legend(std::ostream& out, const std::vector<Series>& series, const Page& page) {
  const std::size_t columns = legend_columns(series, page), rows = legend_rows(series, columns);
  if (rows == 0)
    out << "unset key\nset bmargin 3.6\n";
  else
    out << "set key bmargin center horizontal maxcols " << columns << " maxrows " << rows << " noopaque\nset bmargin "
        << 4.4 + 1.3 * static_cast<double>(rows) << "\n";
}

bool has_numbers(const Series& s) {
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    if (std::isfinite(s.x[i]) && std::isfinite(s.y[i])) return true;
  }
  return false;
}

void write_panel(std::ostream& out, const Panel& p, int index, const Page& page) {
  out << "set title " << quoted((p.title.empty() ? "" : "{/*1.08 " + p.title + "}") + small_print(p.note))
      << " offset 0,-0.3\nset xlabel " << quoted(p.x_label) << "\nset ylabel " << quoted(p.y_label) << "\n"
      << (p.log_x ? "set logscale x\n" : "unset logscale x\n") << (p.log_y ? "set logscale y\n" : "unset logscale y\n")
      << (p.equal_axes ? "set size ratio -1\n" : "");
  const Range x = range_of(p, false), y = range_of(p, true);
  const auto format = [](bool log, const Range& r) { return log && r.high > 100.0 * r.low ? "10^{%T}" : "%g"; };
  out << "set format x '" << format(p.log_x, x) << "'\nset format y '" << format(p.log_y, y) << "'\n";
  if (std::isfinite(p.x_low) && std::isfinite(p.x_high))
    out << "set xrange [" << p.x_low << ":" << p.x_high << "]\n";
  else
    write_range(out, "x", x, p.log_x, false);
  if (std::isfinite(p.y_low) && std::isfinite(p.y_high))
    out << "set yrange [" << p.y_low << ":" << p.y_high << "]\n";
  else
    write_range(out, "y", y, p.log_y, p.reverse_y);
  if (p.log_x)
    write_log_ticks(out, "x", x);
  else
    out << "set xtics auto\n";
  if (p.log_y)
    write_log_ticks(out, "y", y);
  else
    out << "set ytics auto\n";
  write_legend(out, p.series, page);
  std::string command;
  for (std::size_t k = 0; k < p.series.size(); ++k) {
    const std::string block = "p" + std::to_string(index) + "s" + std::to_string(k);
    if (!has_numbers(p.series[k])) continue;
    write_block(out, block, p.series[k]);
    command +=
        (command.empty() ? "plot " : ", \\\n  ") + curve(block, p.series[k], static_cast<int>(k), p.series.size() == 1);
  }
  out << (command.empty() ? "plot NaN notitle" : command) << "\n";
}

// A round step that makes about four ticks.
double tick_step(double range) {
  const double unit = std::pow(10.0, std::floor(std::log10(range / 4.0)));
  for (const double m : {1.0, 2.0, 5.0}) {
    if (m * unit >= range / 4.0) return m * unit;
  }
  return 10.0 * unit;
}

void write_map(std::ostream& out, const ColourMap& m, int index) {
  out << "$m" << index << " << EOD\n";
  for (int iy = 0; iy < m.ny; ++iy) {
    for (int ix = 0; ix < m.nx; ++ix) {
      const float v = m.value[static_cast<std::size_t>(iy) * m.nx + ix];
      out << (ix > 0 ? " " : "") << (std::isfinite(v) ? format_number(v) : "NaN");
    }
    out << '\n';
  }
  out << "EOD\nset title " << quoted("{/*1.08 " + m.title + "}" + small_print(m.note)) << "\nset xlabel "
      << quoted(m.x_label) << "\nset ylabel " << quoted(m.y_label) << "\nset cblabel " << quoted(m.value_label)
      << " offset 1.6,0\nset format cb '%g'"
      << "\nset rmargin 12\nunset key\nunset bmargin\nunset logscale\nset size ratio -1\nset format x '%.7g'\nset "
         "format y '%.7g'\nset style fill solid 1 noborder\nset xtics "
      << tick_step(m.nx * m.dx) << "\n";
  out << "set xrange [" << m.x0 - 0.5 * m.dx << ":" << m.x0 + (m.nx - 0.5) * m.dx << "]\nset yrange ["
      << m.y0 - 0.5 * m.dx << ":" << m.y0 + (m.ny - 0.5) * m.dx << "]\n";
  for (std::size_t k = 0; k < m.overlay.size(); ++k) {
    write_block(out, "m" + std::to_string(index) + "s" + std::to_string(k), m.overlay[k]);
  }
  out << "unset datafile missing\nplot $m" << index << " matrix using (" << m.x0 << "+$1*" << m.dx << "):(" << m.y0
      << "+$2*" << m.dx << "):3 with image notitle";
  for (std::size_t k = 0; k < m.overlay.size(); ++k) {
    out << ", \\\n  "
        << curve("m" + std::to_string(index) + "s" + std::to_string(k), m.overlay[k], static_cast<int>(k) + 6);
  }
  out << "\nset datafile missing 'nan'\n";
}

// Panels that share an axis of the same name share its range, too; and one legend, below the last, when all have the same.
std::vector<Panel> aligned(std::vector<Panel> panel) {
  Range shared;
  bool same_axis = panel.size() > 1, same_legend = panel.size() > 1;
  const auto labels = [](const Panel& p) {
    std::string all;
    for (const Series& s : p.series) all += s.label + '\n';
    return all;
  };
  for (const Panel& p : panel) {
    same_axis = same_axis && p.x_label == panel[0].x_label && !p.log_x && !std::isfinite(p.x_low);
    same_legend = same_legend && labels(p) == labels(panel[0]);
    const Range r = range_of(p, false);
    shared.low = std::min(shared.low, r.low), shared.high = std::max(shared.high, r.high);
  }
  for (std::size_t k = 0; k < panel.size(); ++k) {
    if (same_axis && shared.high > shared.low) panel[k].x_low = shared.low, panel[k].x_high = shared.high;
    if (same_legend && k + 1 < panel.size()) {
      for (Series& s : panel[k].series) s.label.clear();
    }
  }
  return panel;
}

std::string script(const Figure& f, const std::string& kind, const std::string& output) {
  std::ostringstream out;
  out.precision(10);
  const std::vector<Panel> panel = aligned(f.panel);
  const Page page{f.width_mm, kind == ".svg"};
  const auto legend_mm = [&](const std::vector<Series>& s) {
    const double row = page.svg ? 7.0 : 5.2, axis = page.svg ? 8.0 : 0.0;  // SVG's characters are taken to be larger
    return axis + row * static_cast<double>(legend_rows(s, legend_columns(s, page)));
  };
  std::vector<double> heights;
  heights.reserve(panel.size() + f.map.size());
  for (const Panel& p : panel) heights.push_back(f.panel_height_mm + legend_mm(p.series));
  for (const ColourMap& m : f.map) heights.push_back(1.4 * f.panel_height_mm + (m.note.empty() ? 0.0 : 9.0));
  double height = f.title.empty() ? 0.0 : 9.0;
  for (const double h : heights) height += h;
  out << terminal(kind, f.width_mm, height) << "set output " << quoted(output) << "\n";
  write_common(out);
  if (panel.size() > 1) out << "set lmargin 11\n";  // the axes of stacked panels stand in one line
  const bool several = heights.size() > 1 || !f.title.empty();
  if (several) out << "set multiplot" << (f.title.empty() ? "" : " title " + quoted(f.title) + " font ',12'") << "\n";
  double top = f.title.empty() ? height : height - 9.0;
  for (std::size_t k = 0; k < heights.size(); ++k) {
    top -= heights[k];
    if (several) out << "set origin 0," << top / height << "\nset size noratio 1," << heights[k] / height << "\n";
    if (k < panel.size())
      write_panel(out, panel[k], static_cast<int>(k), page);
    else
      write_map(out, f.map[k - panel.size()], static_cast<int>(k - panel.size()));
  }
  if (several) out << "unset multiplot\n";
  out << "unset output\n";
  return out.str();
}

std::string read_all(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

// The script goes through a pipe; what gnuplot says goes to `log`.
void run_gnuplot(const std::string& commands, const std::string& log) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) throw Error(ErrorKind::resource, "no pipe for gnuplot");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[0], 0);
  posix_spawn_file_actions_addopen(&actions, 1, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_adddup2(&actions, 1, 2);
  char name[] = "gnuplot", dash[] = "-";
  char* arguments[] = {name, dash, nullptr};
  pid_t pid = 0;
  const int problem = ::posix_spawnp(&pid, name, &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(ends[0]);
  if (problem != 0) {
    ::close(ends[1]);
    throw Error(ErrorKind::resource, "--plot needs gnuplot (package gnuplot-nox), which cannot be started");
  }
  const auto before = std::signal(SIGPIPE, SIG_IGN);
  for (std::size_t done = 0; done < commands.size();) {
    const ssize_t n = ::write(ends[1], commands.data() + done, commands.size() - done);
    if (n <= 0) break;
    done += static_cast<std::size_t>(n);
  }
  ::close(ends[1]);
  std::signal(SIGPIPE, before);
  int status = 0;
  while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) {}
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    throw Error(ErrorKind::resource, "gnuplot failed: " + read_all(log).substr(0, 500));
  }
}

// gnuplot ends well on a full disk too; a file that is all there ends as its format wants.
bool is_whole(const std::string& path, const std::string& kind) {
  constexpr std::size_t tail = 32;
  std::error_code problem;
  const std::uintmax_t size = fs::file_size(path, problem);
  if (problem || size < tail) return false;
  std::ifstream in(path, std::ios::binary);
  in.seekg(-static_cast<std::streamoff>(tail), std::ios::end);
  std::string end(tail, '\0');
  in.read(end.data(), tail);
  return end.find(kind == ".svg" ? "</svg>" : kind == ".png" ? "IEND" : "%%EOF") != std::string::npos;
}

}  // namespace

std::string plain_text(const std::string& name) {
  std::string out;
  for (const char c : name) {
    if (std::string("_^{}@&~\\").find(c) != std::string::npos) out += '\\';
    out += c;
  }
  return out;
}

void check_plot_path(const std::string& path) {
  const std::string e = extension(path);
  if (e != ".svg" && e != ".png" && e != ".pdf") {
    throw Error(ErrorKind::usage, "--plot " + path + ": the name must end in .svg, .png or .pdf");
  }
  const fs::path folder = fs::path(path).parent_path();
  if (folder.empty()) return;
  std::error_code problem;
  fs::create_directories(folder, problem);
  if (problem) {
    throw Error(ErrorKind::resource, "--plot " + path + ": the folder cannot be made: " + problem.message());
  }
}

void write_figure(const Figure& figure, const std::string& path) {
  check_plot_path(path);
  const std::string kind = extension(path);
  const std::string aside = path + ".part-" + std::to_string(::getpid()) + kind, log = aside + ".log";
  try {
    run_gnuplot(script(figure, kind, aside), log);
    if (!is_whole(aside, kind)) throw Error(ErrorKind::resource, path + ": cannot be written whole (is there room?)");
    fs::rename(aside, path);
    fs::remove(log);
  } catch (...) {
    std::error_code ignored;
    fs::remove(aside, ignored);
    fs::remove(log, ignored);
    throw;
  }
}

std::string figure_as_svg(const Figure& figure) {
  const fs::path folder = fs::temp_directory_path() / ("gdesp-figure-" + std::to_string(::getpid()));
  fs::create_directories(folder);
  const std::string path = (folder / "figure.svg").string();
  try {
    write_figure(figure, path);
    const std::string svg = read_all(path);
    fs::remove_all(folder);
    return svg.substr(svg.find("<svg"));
  } catch (...) {
    std::error_code ignored;
    fs::remove_all(folder, ignored);
    throw;
  }
}

}  // namespace gdesp::analysis
