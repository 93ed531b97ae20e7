// SPDX-License-Identifier: GPL-3.0-or-later
// gmsh sets OpenMP's thread count to 1, throws std::string, does not complain about garbage, and lets OpenCASCADE
// write to stdout: it runs in a child process.
#include <fcntl.h>
#include <gmsh.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <map>
#include <unordered_map>

#include "core/error.hpp"
#include "geometry/mesh_reader.hpp"
#include "io/isolated.hpp"
#include "io/safe_file.hpp"

namespace gdesp::geometry {
namespace {

void silence_stdout() {
  const int nowhere = ::open("/dev/null", O_WRONLY);
  if (nowhere >= 0) ::dup2(nowhere, 1);
}

void start_gmsh() {
  silence_stdout();
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::option::setNumber("General.AbortOnError", 2);
  gmsh::option::setString("Geometry.OCCTargetUnit", "M");
  gmsh::logger::start();
}

/// First "Error:" line of gmsh's log, or "".
std::string first_error() {
  std::vector<std::string> log;
  gmsh::logger::get(log);
  for (const auto& line : log) {
    if (line.rfind("Error", 0) == 0) return line;
  }
  return "";
}

class NodeNumbers {
 public:
  explicit NodeNumbers(TriangleMesh& mesh) : mesh_(mesh) {
    std::vector<std::size_t> tags;
    std::vector<double> coordinates, ignored;
    gmsh::model::mesh::getNodes(tags, coordinates, ignored, -1, -1, false, false);
    for (std::size_t k = 0; k < tags.size(); ++k) {
      all_[tags[k]] = {coordinates[3 * k], coordinates[3 * k + 1], coordinates[3 * k + 2]};
    }
  }
  std::int32_t operator()(std::size_t tag) {
    const auto [at, fresh] = used_.try_emplace(tag, static_cast<std::int32_t>(mesh_.vertex.size()));
    if (fresh) {
      const auto found = all_.find(tag);
      if (found == all_.end()) throw std::string("an element names node " + std::to_string(tag) + ", which is missing");
      mesh_.vertex.push_back(found->second);
    }
    return at->second;
  }

 private:
  TriangleMesh& mesh_;
  std::unordered_map<std::size_t, Vec3d> all_;
  std::unordered_map<std::size_t, std::int32_t> used_;
};

void add_polygon(TriangleMesh& mesh, NodeNumbers& number, const std::size_t* corner, int corners) {
  const std::int32_t a = number(corner[0]);
  for (int k = 2; k < corners; ++k) mesh.triangle.push_back({a, number(corner[k - 1]), number(corner[k])});
}

/// Faces that belong to one tetrahedron only.
void add_hull_of_tetrahedra(TriangleMesh& mesh, NodeNumbers& number) {
  std::vector<std::size_t> tags, nodes;
  gmsh::model::mesh::getElementsByType(4, tags, nodes);
  static const int face[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  std::map<std::array<std::size_t, 3>, std::pair<int, std::array<std::size_t, 3>>> seen;
  for (std::size_t t = 0; t < tags.size(); ++t) {
    for (const auto& f : face) {
      const std::array<std::size_t, 3> corner = {nodes[4 * t + f[0]], nodes[4 * t + f[1]], nodes[4 * t + f[2]]};
      auto key = corner;
      std::sort(key.begin(), key.end());
      auto& entry = seen[key];
      ++entry.first;
      entry.second = corner;
    }
  }
  for (const auto& [key, entry] : seen) {
    if (entry.first == 1) add_polygon(mesh, number, entry.second.data(), 3);
  }
}

TriangleMesh collect(const std::string& path) {
  TriangleMesh mesh;
  NodeNumbers number(mesh);
  std::vector<int> types;
  gmsh::model::mesh::getElementTypes(types);
  bool tetrahedra = false;
  for (const int type : types) {
    std::string name;
    int dimension = 0, order = 0, nodes_each = 0, corners = 0;
    std::vector<double> ignored;
    gmsh::model::mesh::getElementProperties(type, name, dimension, order, nodes_each, ignored, corners);
    tetrahedra = tetrahedra || type == 4;
    if (dimension != 2 || corners < 3) continue;
    std::vector<std::size_t> tags, nodes;
    gmsh::model::mesh::getElementsByType(type, tags, nodes);
    for (std::size_t e = 0; e < tags.size(); ++e) add_polygon(mesh, number, &nodes[e * nodes_each], corners);
  }
  if (mesh.empty() && tetrahedra) add_hull_of_tetrahedra(mesh, number);
  if (mesh.empty()) throw Error(ErrorKind::input, path + ": gmsh found no surface in it");
  return mesh;
}

bool has_elements() {
  std::vector<int> types;
  gmsh::model::mesh::getElementTypes(types, 2);
  std::vector<int> solid;
  gmsh::model::mesh::getElementTypes(solid, 3);
  return !types.empty() || !solid.empty();
}

/// The text without comments and without what stands in quotes.
std::string bare_text(const std::string& text) {
  std::string out;
  for (std::size_t k = 0; k < text.size(); ++k) {
    if (text.compare(k, 2, "//") == 0) {
      while (k < text.size() && text[k] != '\n') ++k;
    } else if (text.compare(k, 2, "/*") == 0) {
      const std::size_t end = text.find("*/", k + 2);
      for (; k < text.size() && k < end; ++k)
        if (text[k] == '\n') out += '\n';
      ++k;
    } else if (text[k] == '"') {
      const std::size_t end = text.find('"', k + 1);
      k = end == std::string::npos ? text.size() : end;
      out += ' ';
      continue;
    }
    out += k < text.size() && text[k] != '/' ? text[k] : ' ';
  }
  return out;
}

/// A GEO file is a program: it can run commands, write, delete and read other files. A scene's input may only describe shapes, and
/// gmsh takes whatever it does not recognise for GEO.
void refuse_commands(const std::string& path) {
  const std::string all = read_text_file(path, std::size_t{1} << 30);
  const std::string start = all.substr(0, 200);
  if (start.rfind("$MeshFormat", 0) == 0 || start.rfind("ISO-10303-21", 0) == 0) return;
  const bool geo = path.size() > 4 && path.compare(path.size() - 4, 4, ".geo") == 0;
  if (!geo)
    throw Error(ErrorKind::input,
                path + ": does not begin with " +
                    (path.ends_with(".msh") ? "$MeshFormat (MSH 2 and 4 do)" : "ISO-10303-21 (STEP does)"));
  static const char* const words[] = {"SystemCall", "NonBlockingSystemCall",
                                      "Print",      "Printf",
                                      "Save",       "SaveAll",
                                      "UnlinkFile", "CreateDir",
                                      "Plugin",     "Include",
                                      "Merge",      "ShapeFromFile",
                                      "Exit",       "Abort",
                                      "General",    "OnelabRun",
                                      "SetString",  "GetEnv"};
  const std::string text = bare_text(all);
  std::size_t line = 1;
  std::string word;
  for (const char c : text + " ") {
    if (std::isalnum(static_cast<unsigned char>(c)) || c == '_') {
      word += c;
      continue;
    }
    for (const char* const w : words) {
      if (word == w)
        throw Error(ErrorKind::input,
                    path + ":" + std::to_string(line) + ": \"" + word +
                        "\" is a command to gmsh, not a shape; a GEO file of a scene may only describe geometry");
    }
    word.clear();
    line += c == '\n';
  }
}

TriangleMesh read_surface(const std::string& path, double mesh_size) {
  refuse_commands(path);
  start_gmsh();
  try {
    gmsh::open(path);
    const std::string error = first_error();
    if (!error.empty()) throw Error(ErrorKind::input, path + ": gmsh says: " + error);
    if (!has_elements()) {
      gmsh::vectorpair entities;
      gmsh::model::getEntities(entities, 2);
      if (entities.empty()) throw Error(ErrorKind::input, path + ": gmsh found no surface in it");
      if (mesh_size <= 0.0) {
        throw Error(ErrorKind::input, path + ": a GEO or STEP file has to be meshed; give mesh_size (m)");
      }
      gmsh::option::setNumber("Mesh.MeshSizeMax", mesh_size);
      gmsh::option::setNumber("Mesh.MeshSizeMin", 0.1 * mesh_size);
      gmsh::model::mesh::generate(2);
    }
    return collect(path);
  } catch (const std::string& why) {
    throw Error(ErrorKind::input, path + ": gmsh says: " + why);
  } catch (const Error&) { throw; } catch (const std::exception& e) {
    throw Error(ErrorKind::input, path + ": gmsh says: " + e.what());
  }
}

}  // namespace

TriangleMesh read_mesh_gmsh(const std::string& path, double mesh_size) {
  const auto points = read_isolated(path, "gmsh", [mesh_size](const std::string& file, MemoryPoints& out) {
    TriangleMesh mesh = read_surface(file, mesh_size);
    out.position = std::move(mesh.vertex);
    out.surface.triangle = std::move(mesh.triangle);
    out.surface.body.assign(out.surface.triangle.size(), 0);
  });
  return {std::move(points->position), std::move(points->surface.triangle)};
}

}  // namespace gdesp::geometry
