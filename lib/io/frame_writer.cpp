// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <filesystem>

#include "core/error.hpp"
#include "io/frame.hpp"
#include "io/run_folder.hpp"
#include "io/safe_file.hpp"
#include "io/tables.hpp"

namespace gdesp {
namespace {

namespace fs = std::filesystem;

bool is_run(const fs::path& folder) {
  return fs::exists(folder / "frames") || fs::exists(folder / "case.link") || fs::exists(folder / "run.json");
}

void check_folder(const fs::path& folder, bool force, bool resume) {
  if (!fs::exists(folder) || resume) return;
  if (!fs::is_directory(folder)) throw Error(ErrorKind::usage, folder.string() + ": is a file, expected a run folder");
  if (fs::is_empty(folder)) return;
  if (!force)
    throw Error(ErrorKind::usage, folder.string() + ": exists already; --force replaces it, --resume goes on");
  if (!is_run(folder))
    throw Error(ErrorKind::usage, folder.string() + ": is a folder but no run (it has no frames): not replaced");
}

/// Removes what an earlier run left under the names that this one will write.
void clear_run(const fs::path& folder) {
  fs::remove_all(folder / "frames");
  for (const char* kind : frame_kinds) fs::remove(folder / (std::string(kind) + ".pvd"));
}

/// Body states side by side, as field data carries them.
struct BodyColumns {
  std::vector<double> centre, velocity, angular_velocity, orientation, force, torque;
  explicit BodyColumns(const std::vector<BodyState>& states) {
    const auto push = [](std::vector<double>& column, const Vec3d& v) { column.insert(column.end(), {v.x, v.y, v.z}); };
    for (const BodyState& s : states) {
      push(centre, s.centre);
      push(velocity, s.velocity);
      push(angular_velocity, s.angular_velocity);
      orientation.insert(orientation.end(), s.orientation, s.orientation + 4);
      push(force, s.force);
      push(torque, s.torque);
    }
  }
  void add_to(std::vector<VtpArray>& field) const {
    const auto add = [&field](const char* name, const std::vector<double>& column, int parts) {
      field.push_back({name, ScalarType::float64, parts, column.data(), column.size() / std::size_t(parts)});
    };
    add("body_centre", centre, 3);
    add("body_velocity", velocity, 3);
    add("body_angular_velocity", angular_velocity, 3);
    add("body_orientation", orientation, 4);
    add("body_force", force, 3);
    add("body_torque", torque, 3);
  }
};

/// Surfaces of far lakes one after the other, and how many columns each has.
struct FarLakeColumns {
  std::vector<std::int64_t> count;
  std::vector<double> x, level, velocity;
  explicit FarLakeColumns(const std::vector<FarLakeTable>& lakes) {
    for (const FarLakeTable& lake : lakes) {
      count.push_back(static_cast<std::int64_t>(lake.x.size()));
      x.insert(x.end(), lake.x.begin(), lake.x.end());
      level.insert(level.end(), lake.level.begin(), lake.level.end());
      velocity.insert(velocity.end(), lake.velocity.begin(), lake.velocity.end());
    }
  }
  void add_to(std::vector<VtpArray>& field) const {
    field.push_back({"far_lake_columns", ScalarType::int64, 1, count.data(), count.size()});
    field.push_back({"far_lake_x", ScalarType::float64, 1, x.data(), x.size()});
    field.push_back({"far_lake_level", ScalarType::float64, 1, level.data(), level.size()});
    field.push_back({"far_lake_velocity", ScalarType::float64, 1, velocity.data(), velocity.size()});
  }
};

}  // namespace

FrameWriter::FrameWriter(std::string run_folder, Vec3d offset, double dp, bool force, bool resume)
    : folder_(std::move(run_folder)), offset_(offset), dp_(dp) {
  while (folder_.size() > 1 && folder_.back() == '/') folder_.pop_back();
  try {
    check_folder(folder_, force, resume);
    if (fs::exists(folder_) && !resume) clear_run(folder_);
    fs::create_directories(fs::path(folder_) / "frames");
  } catch (const fs::filesystem_error& problem) {
    throw Error(ErrorKind::resource, folder_ + ": cannot be written: " + problem.code().message());
  }
  if (resume) written_ = list_frames(folder_);
  next_ = static_cast<int>(written_.size());
}

FramePaths FrameWriter::write(const Frame& frame) {
  while (!written_.empty() && written_.back().time >= frame.time) written_.pop_back();
  next_ = static_cast<int>(written_.size());
  const double offset[3] = {offset_.x, offset_.y, offset_.z};
  std::vector<VtpArray> field{{"time", ScalarType::float64, 1, &frame.time, 1},
                              {"TimeValue", ScalarType::float64, 1, &frame.time, 1},
                              {"step", ScalarType::int64, 1, &frame.step, 1},
                              {"dp", ScalarType::float64, 1, &dp_, 1},
                              {"offset", ScalarType::float64, 3, offset, 1}};
  FramePaths paths;
  paths.time = frame.time;
  paths.step = frame.step;
  const auto part = [&](const char* kind, bool present, auto write_part) {
    if (!present) return;
    const std::string path = folder_ + "/" + frame_name(kind, next_);
    write_part(path);
    frame_path(paths, kind) = path;
  };
  part("fluid", !frame.fluid.position.empty(), [&](const std::string& p) { write_fluid(p, frame.fluid, field); });
  part("grains", !frame.grains.position.empty(), [&](const std::string& p) { write_grains(p, frame.grains, field); });
  const BodyColumns columns(frame.body_states);
  std::vector<VtpArray> body_field = field;
  if (!frame.body_states.empty()) columns.add_to(body_field);
  const FarLakeColumns far(frame.far_lakes);
  if (!frame.far_lakes.empty()) far.add_to(body_field);
  part("bodies", !frame.bodies.triangle.empty() || !frame.body_states.empty(),
       [&](const std::string& p) { write_triangles(p, frame.bodies, body_field); });
  written_.push_back(paths);
  next_ = static_cast<int>(written_.size());
  for (const char* kind : frame_kinds) {
    const bool any =
        std::any_of(written_.begin(), written_.end(), [&](FramePaths& f) { return !frame_path(f, kind).empty(); });
    const std::string series = folder_ + "/" + kind + ".pvd";
    if (any || fs::exists(series)) write_text_file(series, pvd_text(folder_, kind, written_));
  }
  return paths;
}

}  // namespace gdesp
