// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/report.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "analysis/comparison.hpp"
#include "analysis/energy_measurement.hpp"
#include "analysis/gauge_measurement.hpp"
#include "analysis/html_page.hpp"
#include "analysis/map_measurement.hpp"
#include "analysis/profile_measurement.hpp"
#include "analysis/run_quantity.hpp"
#include "analysis/run_record.hpp"
#include "analysis/run_up_measurement.hpp"
#include "analysis/slide_measurement.hpp"
#include "core/error.hpp"
#include "core/version.hpp"

namespace gdesp::analysis {
namespace {

namespace fs = std::filesystem;

std::string rounded(double value, int digits = 4) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

std::string read_text(const std::string& path) {
  std::ifstream in(path);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// A measurement with its table; begun only when the run has what it needs.
struct Part {
  std::unique_ptr<Measurement> measurement;
  Table table;
};

class Report {
 public:
  Report(FrameSource& source, const SourceOptions& options, const ReportOptions& report)
      : source_(source), options_(options), report_(report), info_(source.info()) {
    if (!info_.run_path.empty()) record_ = read_run_record(info_.run_path);
    if (!info_.run_path.empty()) log_ = read_run_log(info_.run_path);
  }

  std::string make(const std::function<void(double, double)>& progress) {
    begin_parts();
    std::vector<Measurement*> measurements;
    std::vector<RowSink> sinks;
    for (Part& part : parts_) {
      measurements.push_back(part.measurement.get());
      sinks.push_back([&part](const std::vector<Cell>& row) { part.table.row.push_back(row); });
    }
    run_measurements(source_, measurements, sinks, progress);
    find_warnings();
    HtmlPage page(info_.scene.title.empty() ? info_.name : info_.scene.title, subtitle());
    write_summary(page);
    write_scene(page);
    write_figures(page);
    write_diagnostics(page);
    write_reproduction(page);
    return page.text();
  }

  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  template <class M>
  M* add(std::unique_ptr<M> measurement) {
    M* raw = measurement.get();
    Part part;
    part.table.column = raw->begin(info_);
    part.measurement = std::move(measurement);
    parts_.push_back(std::move(part));
    return raw;
  }

  bool has_solids() const { return info_.slide_centre.has_value() || !info_.scene.slides.empty(); }

  void begin_parts() {
    parts_.reserve(8);
    if (info_.still_water_level && info_.fluid_count > 0)
      run_up_ = add(std::make_unique<RunUpMeasurement>(RunUpOptions{}));
    ProfileOptions profile;
    const double end = record_ && record_->simulated > 0.0 ? record_->simulated : info_.scene.time.end;
    for (int k = 0; k < 4; ++k) profile.times.push_back(end * k / 3.0);
    if (info_.has_case) profile_ = add(std::make_unique<ProfileMeasurement>(profile));
    if (!info_.scene.gauges.empty()) gauge_ = add(std::make_unique<GaugeMeasurement>(GaugeOptions{}));
    if (has_solids()) slide_ = add(std::make_unique<SlideMeasurement>(SlideOptions{}));
    energy_ = add(std::make_unique<EnergyMeasurement>());
    if (info_.dimensions == 2 || info_.fluid_count == 0) return;
    MapOptions map;
    const Vec3d size = info_.domain.upper - info_.domain.lower;
    map.cell = report_.map_cell > 0.0 ? report_.map_cell : std::max(info_.dp, std::sqrt(size.x * size.y / 2.5e5));
    map_ = add(std::make_unique<MapMeasurement>(map));
  }

  std::string subtitle() const {
    std::string text = "G-DeSp " + std::string(gdesp::version) + " (" + gdesp::commit + "), run " + info_.name;
    if (record_) text += ", " + (record_->device_name.empty() ? record_->device : record_->device_name);
    return text;
  }

  void find_warnings() {
    if (record_ && record_->status != "done")
      warnings_.push_back("The run is not complete: its status is \"" + record_->status +
                          "\". The numbers below end with its last frame.");
    if (source_.failed()) warnings_.push_back("The solver reported a failure: " + source_.failure());
    if (!record_) warnings_.push_back("The run folder has no run.json: how the run was made is not known.");
    const auto largest = [&](const char* name) {
      double value = -1.0;
      if (const auto* column = log_.find(name)) {
        for (const double v : *column) value = std::max(value, v);
      }
      return value;
    };
    const double mach = largest("mach"), overlap = largest("largest_overlap"), lost = largest("lost_fluid"),
                 grains = largest("lost_grains");
    if (mach > 0.2)
      warnings_.push_back("The flow reached Mach " + rounded(mach, 3) +
                          ", above 0.2: the water behaves compressibly; raise numerics.sound_speed.");
    if (overlap > 0.05)
      warnings_.push_back("Grains overlapped by up to " + rounded(100 * overlap, 3) +
                          " % of a diameter, above 5 %: contacts are too soft for the load (contact.youngs_modulus).");
    if (lost > 0.0) warnings_.push_back(rounded(lost, 6) + " fluid particles left the domain.");
    if (grains > 0.0) warnings_.push_back(rounded(grains, 6) + " grains left the domain.");
    if (run_up_ && run_up_->most_torn() > 0)
      warnings_.push_back(
          "Up to " + std::to_string(run_up_->most_torn()) +
          " water particles at a time were torn (density below 0.9 of water at rest); they count as splash. Many of "
          "them in one place point to a flaw of the walls or of the first state there.");
    if (run_up_) {
      std::string unresolved;
      for (const auto& m : run_up_->maxima()) {
        if (m.climbs && m.height < 2.0 * info_.dp)
          unresolved += (unresolved.empty() ? "" : ", ") + (m.region == "all" ? std::string("whole shore") : m.region);
      }
      if (!unresolved.empty())
        warnings_.push_back("The run-up is less than two particle spacings high (" + unresolved +
                            "; dp = " + rounded(info_.dp) + " m): it is not resolved. Take a finer resolution.");
    }
    if (report_.coarser.size() < 2)
      warnings_.push_back(
          "No error bars from resolution: they need this scene at two other resolutions (--with RUN, twice). The "
          "run-up is read to one particle spacing, " +
          rounded(info_.dp) + " m; its discretisation error may be larger.");
  }

  void write_summary(HtmlPage& page) {
    page.heading("Result");
    for (const std::string& picture : report_.pictures)
      page.png(picture, "The scene: ground, water coloured by speed, slide.");
    write_run_up(page);
    std::vector<std::string> lines;
    for (const Part& part : parts_) {
      std::string text = part.measurement->summary();
      if (text.empty() || part.measurement.get() == profile_) continue;
      text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
      lines.push_back(text);
    }
    for (const std::string& w : warnings_) page.warning(w);
    page.list(lines);
  }

  void write_scene(HtmlPage& page) {
    page.heading("Scene and models");
    Table t{{"property", "value"}, {}};
    const auto row = [&](const std::string& name, const std::string& value) { t.row.push_back({name, value}); };
    const Vec3d size = info_.domain.upper - info_.domain.lower;
    row("dimensions", std::to_string(info_.dimensions));
    row("domain",
        rounded(size.x) + " × " + (info_.dimensions == 3 ? rounded(size.y) + " × " : "") + rounded(size.z) + " m");
    row("particle spacing dp", rounded(info_.dp) + " m");
    row("fluid particles at the start", format_number(static_cast<double>(info_.fluid_count)));
    if (info_.still_water_level) row("still-water level", rounded(*info_.still_water_level + info_.offset.z, 7) + " m");
    if (info_.has_case) {
      row("fluid",
          rounded(info_.fluid_density()) + " kg/m³, " + rounded(info_.scene.fluid.kinematic_viscosity) + " m²/s");
      for (const Slide& s : info_.scene.slides) {
        std::string text = s.kind + ", " + rounded(s.density) + " kg/m³";
        if (s.kind == "granular") text += ", grains " + rounded(s.diameter) + " m, porosity " + rounded(s.porosity);
        row("slide \"" + s.name + "\"", text);
      }
      row("preset", info_.scene.numerics.preset);
    }
    page.table(t);
    if (!record_ || !record_->json.contains("scene") || !record_->json["scene"].contains("models")) return;
    page.paragraph(
        "What was modelled, and what was left out because the scene does not need it or an option switched it off:");
    Table models{{"model", "", "what"}, {}};
    for (const auto& [name, model] : record_->json["scene"]["models"].items()) {
      models.row.push_back(
          {name, std::string(model.value("on", false) ? "on" : "off"), model.value("what", std::string())});
    }
    page.table(models);
    page.paragraph(
        "Left out in every run: the air, surface tension, a turbulence closure, seepage and erosion of the ground, "
        "breaking of grains, and "
        "what released the slide.");
  }

  /// Error bar of one region from the runs at other resolutions; NaN when they do not converge.
  Convergence convergence_of(const std::string& region, double value) {
    std::vector<double> spacing{info_.dp}, heights{value};
    for (const std::string& run : report_.coarser) {
      SourceOptions other = options_;
      other.inputs = {run};
      const RunQuantity q = measure_quantity(other, region == "all" ? "runup" : "runup:" + region);
      spacing.push_back(q.dp);
      heights.push_back(q.value);
    }
    return assess_convergence(spacing, heights);
  }

  void write_run_up(HtmlPage& page) {
    if (!run_up_) return;
    Table t{{"bank or region", "highest run-up [m]", "resolution [m]", "at t [s]", "x [m]", "y [m]", "z [m]"}, {}};
    const bool bars = report_.coarser.size() >= 2;
    if (bars) t.column.insert(t.column.end(), {"convergence", "order", "extrapolated [m]", "error bar ± [m]"});
    for (const auto& m : run_up_->maxima()) {
      const double none = std::nan("");
      std::vector<Cell> cells{m.region == "all" ? std::string("whole shore") : m.region,
                              std::round(1e2 * m.height) / 1e2,
                              info_.dp,
                              m.climbs ? m.time : none,
                              m.climbs ? std::round(10 * m.at.x) / 10 : none,
                              m.climbs ? std::round(10 * m.at.y) / 10 : none,
                              m.climbs ? std::round(10 * m.at.z) / 10 : none};
      if (bars) {
        const Convergence c = convergence_of(m.region, m.height);
        cells.insert(cells.end(), {to_string(c.kind), std::round(100 * c.order) / 100,
                                   std::round(1e3 * c.extrapolated) / 1e3, std::round(1e3 * c.error_bar) / 1e3});
      }
      t.row.push_back(std::move(cells));
    }
    page.table(t);
    page.paragraph(
        "Run-up: highest point of the connected water on a bank above still water, with the film it thins to; splash "
        "is "
        "counted apart. The reading resolves one particle spacing." +
        std::string(bars ? " Error bar: grid convergence index (Celik et al. 2008) of the three finest runs." : ""));
  }

  void write_figures(HtmlPage& page) {
    const auto section = [&](Measurement* m, const char* heading, const char* caption) {
      if (!m) return;
      page.heading(heading);
      const Figure figure = m->figure();
      const bool curves =
          std::any_of(figure.panel.begin(), figure.panel.end(), [](const Panel& p) { return !p.series.empty(); });
      if (curves || !figure.map.empty())
        page.figure(figure, caption);
      else
        page.paragraph(m->summary() + ".");
    };
    section(run_up_, "Run-up", "Run-up against time, and where some is found, its maximum along the shore.");
    section(profile_, "Profiles", "Surfaces of water and slide along a section, at four times.");
    section(map_, "Maps", "Highest water level and arrival time.");
    section(gauge_, "Gauges", "Water level (and pressure) at the gauges.");
    section(slide_, "Slide", "Speed of the centre of mass, travel of the front, submerged share.");
    section(energy_, "Energy", "Energy by phase and kind, from the frames.");
  }

  void write_diagnostics(HtmlPage& page) {
    if (log_.name.empty()) return;
    page.heading("Diagnostics");
    Table t{{"quantity", "unit", "first", "last", "smallest", "largest"}, {}};
    const char* const quantities[][3] = {{"fluid_mass", "mass of the water", "kg"},
                                         {"grain_mass", "mass of the grains", "kg"},
                                         {"fluid_momentum", "momentum of the water, magnitude", "kg m/s"},
                                         {"grain_momentum", "momentum of the grains, magnitude", "kg m/s"},
                                         {"fluid_kinetic", "kinetic energy of the water", "J"},
                                         {"fluid_elastic", "elastic energy of the water", "J"},
                                         {"grain_kinetic", "kinetic energy of the grains", "J"},
                                         {"largest_speed", "largest speed of the water", "m/s"},
                                         {"largest_grain_speed", "largest speed of a grain", "m/s"},
                                         {"mach", "Mach number", "1"},
                                         {"largest_density_error", "largest density error", "1"},
                                         {"largest_overlap", "worst overlap of two grains over their diameter", "1"},
                                         {"lost_fluid", "water particles lost", "1"},
                                         {"lost_grains", "grains lost", "1"},
                                         {"dt", "time step", "s"}};
    const auto four = [](double v) { return std::stod(rounded(v, 4)); };
    for (const auto& q : quantities) {
      const auto* column = log_.find(q[0]);
      if (!column || column->empty()) continue;
      const auto [low, high] = std::minmax_element(column->begin(), column->end());
      if (*high == 0.0 && *low == 0.0 && std::string(q[0]).find("grain") != std::string::npos && !has_solids())
        continue;
      t.row.push_back(
          {std::string(q[1]), std::string(q[2]), four(column->front()), four(column->back()), four(*low), four(*high)});
    }
    page.table(t);
    const auto* time = log_.find("t");
    if (!time) return;
    Figure figure;
    figure.panel_height_mm = 58.0;
    const auto panel = [&](const char* title, const char* label, const char* name, bool log_y) {
      const auto* column = log_.find(name);
      if (!column) return;
      Panel p;
      p.title = title;
      p.x_label = "time t (s)";
      p.y_label = label;
      p.log_y = log_y;
      p.series.push_back({"", *time, *column, {}, {}, MarkStyle::line, {}, 0});
      figure.panel.push_back(std::move(p));
    };
    panel("Time step", "dt (s)", "dt", false);
    panel("Mach number", "largest speed / c_0", "mach", false);
    panel("Density error", "largest |rho/rho_0 - 1|", "largest_density_error", false);
    page.figure(figure, "What the solver watched while it ran.");
  }

  void write_reproduction(HtmlPage& page) {
    page.heading("How to reproduce");
    std::vector<std::string> lines;
    if (info_.has_case) lines.push_back("case: " + info_.case_path);
    if (record_) {
      lines.push_back("command: " + record_->command);
      lines.push_back("version: " + record_->version + " (" + record_->commit + ")");
      lines.push_back("device: " + record_->device + " " + record_->device_name +
                      ", threads: " + std::to_string(record_->threads));
      lines.push_back("cost: " + rounded(record_->wall_seconds) + " s for " + rounded(record_->simulated) +
                      " simulated seconds; score N = n t / T = " + rounded(record_->score));
    }
    lines.push_back("this page: surge-analyze report " + info_.name);
    page.list(lines);
    if (info_.has_case)
      page.folded("The scene with every default filled in (case.toml)", read_text(info_.case_path + "/case.toml"));
    if (record_) page.folded("run.json", record_->json.dump(1));
  }

  FrameSource& source_;
  const SourceOptions& options_;
  const ReportOptions& report_;
  const RunInfo& info_;
  std::optional<RunRecord> record_;
  RunLog log_;
  std::vector<Part> parts_;
  RunUpMeasurement* run_up_ = nullptr;
  ProfileMeasurement* profile_ = nullptr;
  GaugeMeasurement* gauge_ = nullptr;
  SlideMeasurement* slide_ = nullptr;
  EnergyMeasurement* energy_ = nullptr;
  MapMeasurement* map_ = nullptr;
  std::vector<std::string> warnings_;
};

}  // namespace

std::vector<std::string> write_report(FrameSource& source, const SourceOptions& options, const ReportOptions& report,
                                      const std::string& path, const std::function<void(double, double)>& progress) {
  Report page(source, options, report);
  const std::string text = page.make(progress);
  const std::string aside = path + ".part-" + std::to_string(::getpid());
  std::ofstream out(aside, std::ios::binary);
  out << text;
  out.close();
  if (!out) {
    std::error_code ignored;
    fs::remove(aside, ignored);
    throw Error(ErrorKind::resource, path + ": cannot be written");
  }
  fs::rename(aside, path);
  return page.warnings();
}

}  // namespace gdesp::analysis
