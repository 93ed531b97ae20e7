// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh_reader.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/OBJ.h>
#include <CGAL/IO/OFF.h>
#include <CGAL/IO/PLY.h>
#include <CGAL/IO/STL.h>
#include <cpl_vsi.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <unordered_map>

#include "core/error.hpp"
#include "geometry/gdal_support.hpp"
#include "io/isolated.hpp"

namespace gdesp::geometry {
namespace {

using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
using Points = std::vector<Point>;
using Polygons = std::vector<std::vector<std::size_t>>;

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw Error(ErrorKind::input, path + ": " + why);
}

/// Lower-case ending without the dot; that before .gz where there is one.
std::string ending(const std::string& path) {
  std::filesystem::path p(path);
  if (p.extension() == ".gz") p = p.stem();
  std::string e = p.extension().string();
  std::transform(e.begin(), e.end(), e.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return e.empty() ? e : e.substr(1);
}

/// A plain copy of a gzipped file, removed at the end.
class Unzipped {
 public:
  explicit Unzipped(const std::string& path) : path_(path) {
    if (std::filesystem::path(path).extension() != ".gz") return;
    gdal_start();
    const QuietGdal quiet;
    temporary_ = std::filesystem::temp_directory_path() /
                 ("gdesp-" + std::to_string(::getpid()) + "-" + std::filesystem::path(path).stem().string());
    VSILFILE* in = VSIFOpenL(gdal_path(path).c_str(), "rb");
    if (!in) refuse(path, "cannot be opened");
    std::ofstream out(temporary_, std::ios::binary);
    char buffer[1 << 16];
    for (std::size_t n = 1; n > 0;) {
      n = VSIFReadL(buffer, 1, sizeof buffer, in);
      out.write(buffer, static_cast<std::streamsize>(n));
    }
    VSIFCloseL(in);
    path_ = temporary_.string();
  }
  ~Unzipped() {
    std::error_code ignored;
    if (!temporary_.empty()) std::filesystem::remove(temporary_, ignored);
  }
  Unzipped(const Unzipped&) = delete;
  Unzipped& operator=(const Unzipped&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  std::filesystem::path temporary_;
};

bool read_soup(const std::string& path, const std::string& format, Points& points, Polygons& polygons) {
  std::cerr.rdbuf(nullptr);  // CGAL tells of broken lines there; this is the child process
  std::ifstream in(path, std::ios::binary);
  if (format == "off") return CGAL::IO::read_OFF(in, points, polygons);
  if (format == "obj") return CGAL::IO::read_OBJ(in, points, polygons);
  if (format == "ply") return CGAL::IO::read_PLY(in, points, polygons);
  return CGAL::IO::read_STL(in, points, polygons);
}

/// A binary STL says how many facets it holds; CGAL does not mind when they are not there.
void check_stl_length(const std::string& path, const std::string& shown) {
  std::ifstream in(path, std::ios::binary);
  char header[84];
  if (!in.read(header, sizeof header)) return;
  const auto size = std::filesystem::file_size(path);
  std::uint32_t count = 0;
  std::copy(header + 80, header + 84, reinterpret_cast<char*>(&count));
  const bool ascii = std::string(header, 5) == "solid";
  if (!ascii && size != 84ull + 50ull * count) {
    refuse(shown, "a binary STL of " + std::to_string(count) + " facets has " + std::to_string(84ull + 50ull * count) +
                      " bytes; this file has " + std::to_string(size));
  }
}

void check_ascii_stl(const std::string& path, const std::string& shown) {
  std::ifstream in(path, std::ios::binary);
  std::string start(5, ' ');
  in.read(start.data(), 5);
  if (start != "solid") return;
  in.seekg(0, std::ios::end);
  const auto size = static_cast<std::streamoff>(in.tellg());
  in.seekg(std::max<std::streamoff>(0, size - 400));
  std::string tail(static_cast<std::size_t>(std::min<std::streamoff>(size, 400)), ' ');
  in.read(tail.data(), static_cast<std::streamsize>(tail.size()));
  if (tail.find("endsolid") != std::string::npos) return;
  in.clear();
  in.seekg(80);
  std::uint32_t count = 0;
  in.read(reinterpret_cast<char*>(&count), 4);
  if (in && size == static_cast<std::streamoff>(84ull + 50ull * count)) return;  // binary that begins with "solid"
  refuse(shown, "ends without \"endsolid\": the ASCII STL was cut short");
}

void join_equal_vertices(TriangleMesh& mesh) {
  struct Hash {
    std::size_t operator()(const Vec3d& v) const {
      const std::hash<double> h;
      return (h(v.x) * 1000003u ^ h(v.y)) * 1000003u ^ h(v.z);
    }
  };
  std::unordered_map<Vec3d, std::int32_t, Hash> seen;
  seen.reserve(mesh.vertex.size());
  std::vector<std::int32_t> index(mesh.vertex.size());
  std::vector<Vec3d> kept;
  for (std::size_t v = 0; v < mesh.vertex.size(); ++v) {
    const Vec3d p = mesh.vertex[v] + Vec3d{0.0, 0.0, 0.0};  // -0 becomes 0
    const auto [at, fresh] = seen.try_emplace(p, static_cast<std::int32_t>(kept.size()));
    if (fresh) kept.push_back(p);
    index[v] = at->second;
  }
  mesh.vertex = std::move(kept);
  for (auto& t : mesh.triangle) t = {index[t.x], index[t.y], index[t.z]};
}

TriangleMesh from_soup(const Points& points, const Polygons& polygons, const std::string& path) {
  TriangleMesh mesh;
  mesh.vertex.reserve(points.size());
  for (const auto& p : points) mesh.vertex.push_back({p.x(), p.y(), p.z()});
  for (const auto& polygon : polygons) {
    if (polygon.size() < 3) refuse(path, "a facet has fewer than three corners");
    for (const auto c : polygon) {
      if (c >= points.size())
        refuse(path, "a facet names vertex " + std::to_string(c) + " of " + std::to_string(points.size()));
    }
    for (std::size_t k = 2; k < polygon.size(); ++k) {
      mesh.triangle.push_back({static_cast<std::int32_t>(polygon[0]), static_cast<std::int32_t>(polygon[k - 1]),
                               static_cast<std::int32_t>(polygon[k])});
    }
  }
  return mesh;
}

/// In a child process: CGAL's readers trust the counts and types that a file states.
void read_surface(const std::string& path, const std::string& format, MemoryPoints& out) {
  Points points;
  Polygons polygons;
  if (!read_soup(path, format, points, polygons)) refuse(path, "is damaged, cut short, or no " + format + " file");
  TriangleMesh mesh = from_soup(points, polygons, path);
  if (format == "stl") join_equal_vertices(mesh);
  out.position = std::move(mesh.vertex);
  out.surface.triangle = std::move(mesh.triangle);
  out.surface.body.assign(out.surface.triangle.size(), 0);
}

TriangleMesh read_mesh_cgal(const std::string& path, const std::string& format) {
  const Unzipped file(path);
  if (format == "stl") {
    check_stl_length(file.path(), path);
    check_ascii_stl(file.path(), path);
  }
  try {
    const auto points = read_isolated(file.path(), "CGAL",
                                      [&](const std::string& p, MemoryPoints& out) { read_surface(p, format, out); });
    return {std::move(points->position), std::move(points->surface.triangle)};
  } catch (const Error& e) {
    if (file.path() == path) throw;
    throw Error(e.kind(), path + " (unpacked): " + e.what());
  }
}

}  // namespace

bool is_mesh_name(const std::string& path) {
  static const std::string known[] = {"stl", "obj", "ply", "off", "vtk", "vtp", "vtu", "msh", "geo", "step", "stp"};
  const std::string e = ending(path);
  return std::find(std::begin(known), std::end(known), e) != std::end(known);
}

TriangleMesh read_mesh(const std::string& path, const MeshOptions& options) {
  if (!std::filesystem::exists(path)) refuse(path, "no such file");
  if (!std::filesystem::is_regular_file(path)) refuse(path, "is not a file");
  if (!is_mesh_name(path))
    refuse(path, "unknown mesh format \"" + ending(path) + "\"; valid: stl obj ply off vtk vtp vtu msh geo step stp");
  const std::string e = ending(path);
  TriangleMesh mesh;
  if (e == "vtk" || e == "vtp" || e == "vtu") {
    mesh = read_mesh_vtk(path);
  } else if (e == "msh" || e == "geo" || e == "step" || e == "stp") {
    mesh = read_mesh_gmsh(path, options.mesh_size / options.scale);
  } else {
    mesh = read_mesh_cgal(path, e);
  }
  if (mesh.empty()) refuse(path, "holds no surface triangle");
  for (std::size_t v = 0; v < mesh.vertex.size(); ++v) {
    const Vec3d& p = mesh.vertex[v];
    if (!std::isfinite(p.x + p.y + p.z)) refuse(path, "vertex " + std::to_string(v) + " is not a number");
  }
  transform(mesh, {options.scale, options.scale, options.scale}, options.translate);
  return mesh;
}

}  // namespace gdesp::geometry
