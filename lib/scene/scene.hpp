// SPDX-License-Identifier: GPL-3.0-or-later
// Everything that makes a scene, as the user writes it in TOML (docs/formats/scene.md). Plain structs with the
// defaults; lengths in metres of the scene's own coordinates (UTM, local, ...), z up, SI units throughout.
// Two dimensions means the vertical plane x-z: y is ignored.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/vec3.hpp"

namespace gdesp {

struct Point2 {
  double x = 0.0, y = 0.0;
};
struct Box {
  Vec3d lower, upper;
};

/// A closed solid, in exactly one of the ways: box; mesh; surface_below + surface_above; polygon + thickness.
struct Shape {
  std::optional<Box> box;
  std::string mesh;                ///< path of a closed surface
  double mesh_size = 0.0;          ///< m, element size when `mesh` is GEO or STEP
  double scale = 1.0;              ///< unit of the file in metres
  Vec3d translate;                 ///< m, after scaling
  std::string surface_below;       ///< heightfields or sheets: sliding surface ...
  std::string surface_above;       ///< ... and top
  std::vector<Point2> polygon;     ///< outline ...
  std::string thickness;           ///< ... and thickness raster (m), on the terrain ...
  double uniform_thickness = 0.0;  ///< ... or, without a raster, the same vertical thickness everywhere, m
};

struct Terrain {
  std::vector<std::string> files;  ///< meshes or rasters (tiles are merged)
  double scale = 1.0;              ///< horizontal unit in metres
  double vertical_scale = 1.0;     ///< vertical unit in metres (-1: depths, positive down)
  double vertical_offset = 0.0;    ///< m, added after scaling (datum)
  std::string crs;                 ///< of the files when they do not say; e.g. "EPSG:2193"
  std::string bathymetry;          ///< points or raster burned in below the water
  std::string bathymetry_crs;
  double bathymetry_scale = 1.0;  ///< vertical; -1 for positive-down depths
  double bathymetry_offset = 0.0;
  std::string condition = "free-slip";  ///< "free-slip" or "no-slip"
};

/// A wall that is not terrain: a tank (open or closed box seen from inside) or a mesh.
struct Wall {
  std::string name;
  std::optional<Box> tank;            ///< inner faces
  std::vector<std::string> open;      ///< tank faces left out: "top", "bottom", "x-", "x+", "y-", "y+"
  std::vector<std::string> symmetry;  ///< tank faces that are planes of symmetry: without friction for grains too
  std::string mesh;                   ///< closed solid, or open sheet (made solid downwards)
  double mesh_size = 0.0, scale = 1.0;
  Vec3d translate;
  std::string condition = "free-slip";
};

struct FluidFill {
  std::string kind = "level";   ///< "level" | "box" | "mesh"
  double level = 0.0;           ///< m, still-water elevation
  std::optional<Point2> seed;   ///< a point in the basin
  std::vector<Point2> polygon;  ///< limits the basin (and seeds it)
  std::optional<Box> box;
  std::string mesh;
};

struct Fluid {
  double density = 1000.0;                         ///< kg/m3
  double kinematic_viscosity = 1.0e-6;             ///< m2/s
  std::string velocity_x, velocity_y, velocity_z;  ///< m/s at the start, formulas of x, y, z (formula.hpp); empty: 0
  std::vector<FluidFill> fill;
};

struct DiameterClass {
  double diameter = 0.0;
  double mass_share = 0.0;
};

struct Slide {
  std::string name = "slide";
  std::string kind = "granular";  ///< "granular" | "rigid" | "prescribed"
  Shape shape;
  double density = 2650.0;           ///< kg/m3 of the grains (granular) or of the body
  double diameter = 0.0;             ///< m, granular
  double diameter_deviation = 0.0;   ///< m, normal distribution
  double diameter_half_width = 0.0;  ///< m, uniform distribution
  std::vector<DiameterClass> sieve;  ///< overrides diameter
  double real_diameter = 0.0;        ///< m, for drag in coarse-grained runs; 0: the grain's own
  double porosity = 0.42;
  std::uint64_t seed = 1;               ///< of the packing
  std::string relaxation = "in-place";  ///< of the packing: "in-place" | "gravity"
  double release_at = 0.0;              ///< s; held before
  Vec3d velocity;                       ///< m/s at the start
  std::vector<std::string> fixed;       ///< rigid: "x", "y", "z", "rotation"
  std::string motion_csv;               ///< prescribed: t,dx,dy,dz
};

/// The wave that a piston makes.
struct Wave {
  std::string kind = "none";         ///< "none" | "solitary"
  double height = 0.0, depth = 0.0;  ///< m
  Vec3d direction{1.0, 0.0, 0.0};    ///< of its travel
};

/// Water behind a piston, as columns that move it (docs/decisions/0081).
struct FarLakeKeys {
  double length = 0.0, depth = 0.0;  ///< m, at rest; length 0: none
  std::uint64_t columns = 0;         ///< 0: five a depth
  std::string side = "x+";           ///< of the piston where it lies: "x+" | "x-"
};

/// A gate, piston or other body with prescribed motion.
struct MovingBody {
  std::string name;
  std::string kind = "gate";  ///< "gate" | "piston" | "body"
  Shape shape;
  Vec3d velocity;           ///< m/s, from `start` on
  double start = 0.0;       ///< s
  double stop = 1e30;       ///< s
  double remove_at = -1.0;  ///< s; < 0: never
  std::string motion_csv;   ///< t,dx,dy,dz instead of velocity
  Wave wave;                ///< piston: instead of both
  FarLakeKeys far_lake;     ///< piston: instead of all of them
  std::string condition = "free-slip";
};

struct FloatingBody {
  std::string name;
  Shape shape;
  double density = 500.0;
  double release_at = 0.0;  ///< s; held before
  Vec3d velocity;
  std::vector<std::string> fixed;  ///< "x", "y", "z", "rotation"
};

/// Contact law of grains with each other, with walls and bodies.
struct Contact {
  std::string law = "hertz";    ///< "hertz" (Hertz-Mindlin) | "linear"
  double youngs_modulus = 0.0;  ///< Pa, hertz; 0: chosen for the scene
  double poisson_ratio = 0.3;
  double stiffness = 1000.0;              ///< N/m, linear, normal
  double stiffness_ratio = 0.2857142857;  ///< tangential / normal, linear
  double restitution = 0.5;
  double friction = 0.5;
  double wall_friction = -1.0;  ///< < 0: as friction
  double rolling_friction = 0.0;
  double cohesion = 0.0;  ///< J/m2
};

struct Coupling {
  bool enabled = true;
  std::string drag = "di-felice";  ///< "ergun-wen-yu" | "di-felice"
  double smoothing_length = 0.0;   ///< m; 0: max(h, 2 d_max)
  double added_mass = 0.5;         ///< coefficient; `paper`: 0
};

/// `paper` and `accurate` set these; a key of its own overrides its preset's value.
struct Numerics {
  std::string preset = "accurate";
  double smoothing_ratio = 1.5;        ///< h / dp; `paper`: 1.3
  double sound_speed = 0.0;            ///< m/s; 0: 10 x the largest expected speed
  double expected_speed = 0.0;         ///< m/s; 0: estimated from the scene
  std::string time_scheme = "split";   ///< "split" (position Verlet, two light passes) | "verlet" (paper A.1-A.3)
  std::string walls = "extrapolated";  ///< "extrapolated" (Adami et al. 2012) | "dynamic"
  std::string wall_layers = "fitted-where-dry";  ///< also "fitted", "lattice": wall particles of terrain and meshes
  std::string viscosity = "artificial";          ///< "artificial" | "morris" | "none"
  double artificial_viscosity = 0.05;            ///< alpha
  double density_diffusion = 0.1;                ///< delta; 0: none
  double shifting = 0.0;                         ///< 0: none
  std::string tension = "cavitation";            ///< "cavitation" | "controlled" | "kept"
  double cfl = 0.0;                              ///< 0: the scheme's own default
  double time_step = 0.0;                        ///< s; 0: adaptive; > 0: fixed (paper)
  double grain_time_step_share = 0.2;            ///< of the Rayleigh (hertz) or contact time (linear)
  bool multirate = true;                         ///< grains sub-step inside the fluid's step
  double skin = 0.0;                             ///< m; 0: chosen
};

/// What a run may leave out because it does not change the answer (docs/economy.md).
struct Economy {
  bool sleep = false;        ///< still water sleeps until it is disturbed; `paper`: false
  double wake_speed = 0.01;  ///< sqrt(g dp): mean velocity in a block of 8 dp that wakes it
  bool viscosity = true;     ///< physical viscosity off where its layer is thinner than 0.2 dp; `paper`: false
  bool near_walls = true;    ///< wall particles away from water are not touched; `paper`: false
};

struct TimeControl {
  double end = 1.0;              ///< s
  double output_interval = 0.0;  ///< s; 0: end / 50
};

struct Gauge {
  std::string name;
  Vec3d at;
  bool has_z = false;
};
struct Section {
  std::string name;
  Point2 from, to;
};
struct Region {
  std::string name;
  std::vector<Point2> polygon;
};

struct Scene {
  std::string title;
  std::string path;  ///< of the file it came from; relative paths start at its folder
  int dimensions = 3;
  Vec3d gravity{0.0, 0.0, -9.81};
  std::optional<Box> domain;                 ///< default: from the geometry
  std::vector<std::string> periodic;         ///< "x", "y", "z"
  std::string wall_particles = "reachable";  ///< "reachable" | "all": where fluid can come to, or everywhere
  double run_up = 0.0;  ///< m above the highest water that counts as reachable; 0: from the expected speed
  double dp = 0.0;      ///< m, particle spacing; required
  Fluid fluid;
  Terrain terrain;
  std::vector<Wall> walls;
  std::vector<Slide> slides;
  std::vector<MovingBody> moving;
  std::vector<FloatingBody> floating;
  Contact contact;
  Coupling coupling;
  Numerics numerics;
  Economy economy;
  TimeControl time;
  std::vector<Gauge> gauges;
  std::vector<Section> sections;
  std::vector<Region> regions;
};

/// Whether the domain repeats along the axis (0: x, 1: y, 2: z).
inline bool is_periodic(const Scene& scene, int axis) {
  return std::find(scene.periodic.begin(), scene.periodic.end(), std::string(1, "xyz"[axis])) != scene.periodic.end();
}

/// A --set override, e.g. {"resolution.dp", "5.0"}; the value is TOML, or a bare word taken as a string.
struct Override {
  std::string key, value;
};

/// Reads and checks a scene. Throws Error(input) that names file, key, line, the value found and what is valid;
/// unknown keys are errors with "did you mean". Input file paths inside come back absolute.
Scene read_scene(const std::string& path, const std::vector<Override>& overrides);

/// The scene with every default filled in, as TOML that read_scene accepts unchanged.
std::string scene_to_toml(const Scene& scene);

/// One row of the key table, from which the parser, docs/formats/scene.md and --help are made.
struct SceneKey {
  std::string key, type, unit, default_value, meaning;
};
const std::vector<SceneKey>& scene_keys();

}  // namespace gdesp
