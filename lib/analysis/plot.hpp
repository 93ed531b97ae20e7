// SPDX-License-Identifier: GPL-3.0-or-later
// Plots for reports and papers, drawn by gnuplot: SVG, PNG or PDF by the file's ending.
// Style: sans serif, ticks outside, light grid, units in the axis labels, colours by Okabe & Ito 2008 (told apart
// with every kind of colour blindness) and different dashes and marks (told apart in black and white).
#pragma once

#include <cmath>
#include <string>
#include <vector>

namespace gdesp::analysis {

enum class MarkStyle { line, thin, points, line_points, dashes, band, impulses, steps };

struct Series {
  std::string label;  ///< empty: not in the legend
  std::vector<double> x, y;
  std::vector<double> low, high;  ///< band, or error bars where given with points
  MarkStyle style = MarkStyle::line;
  std::vector<std::string> name;  ///< a label beside each point
  int colour = -1;                ///< number in the palette; -1: the next
};

struct Panel {
  std::string title, x_label, y_label;
  std::vector<Series> series;
  bool log_x = false, log_y = false, equal_axes = false;
  bool reverse_y = false;
  std::string note;                                             ///< small print under the title
  double x_low = NAN, x_high = NAN, y_low = NAN, y_high = NAN;  ///< where the data's own range is not wanted
};

/// A coloured map: value(ix, iy) at x0 + ix dx, y0 + iy dx; NaN stays white.
struct ColourMap {
  std::string title, x_label, y_label, value_label;
  std::string note;  ///< small print under the title
  double x0 = 0, y0 = 0, dx = 1;
  int nx = 0, ny = 0;
  std::vector<float> value;
  std::vector<Series> overlay;  ///< lines on top; named in the note
};

struct Figure {
  std::string title;
  std::vector<Panel> panel;       ///< one below the other
  std::vector<ColourMap> map;     ///< drawn after the panels
  double width_mm = 160.0;        ///< of the page; a two-column figure of most journals
  double panel_height_mm = 80.0;  ///< without the legend
};

/// Labels and titles are set in gnuplot's enhanced text ("x_0", "m^3"): names that users gave go through this first.
std::string plain_text(const std::string& name);

/// Throws Error(usage) when `path` does not end as a plot can; makes its folder if missing, Error(resource) when that
/// fails. Call before long work.
void check_plot_path(const std::string& path);

/// Draws through a gnuplot process, writes aside and renames. Throws Error(resource) when gnuplot is missing or
/// fails, with what it said; Error(usage) for an ending other than .svg, .png, .pdf.
void write_figure(const Figure& figure, const std::string& path);

/// The same as a string of SVG, to be put inline into a page.
std::string figure_as_svg(const Figure& figure);

}  // namespace gdesp::analysis
