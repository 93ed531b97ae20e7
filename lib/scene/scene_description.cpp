// SPDX-License-Identifier: GPL-3.0-or-later
// Every key of a scene file: name, unit, range, meaning. The only list there is.
#include "scene/scene_visitor.hpp"

namespace gdesp::scene_detail {
namespace {

using V = SceneVisitor;

const std::vector<std::string> wall_conditions{"free-slip", "no-slip"};
const std::vector<std::string> tank_face_names{"top", "bottom", "x-", "x+", "y-", "y+"};
const std::vector<std::string> fixed_motions{"x", "y", "z", "rotation"};

void describe_shape(V& v, Shape& s) {
  v.box({"box", "m", "shape: an axis-parallel box {lower = [x, y, z], upper = [x, y, z]}"}, s.box);
  v.path({"mesh", "", "shape: file of a closed surface"}, s.mesh);
  v.number({"mesh_size", "m", "element size when the mesh is a GEO or STEP file; 0: chosen from dp"}, s.mesh_size,
           not_negative);
  v.number({"scale", "m", "unit of the mesh file"}, s.scale, positive);
  v.vector({"translate", "m", "shift of the shape, after scaling"}, s.translate);
  v.path({"surface_below", "", "shape: sliding surface (heightfield or sheet), with surface_above"}, s.surface_below);
  v.path({"surface_above", "", "shape: top surface (heightfield or sheet), with surface_below"}, s.surface_above);
  v.polygon({"polygon", "m", "shape: outline [[x, y], ...] on the terrain, with thickness or uniform_thickness"},
            s.polygon);
  v.path({"thickness", "", "raster of the vertical thickness in metres, inside polygon"}, s.thickness);
  v.number({"uniform_thickness", "m", "vertical thickness everywhere inside polygon"}, s.uniform_thickness,
           not_negative);
}

void describe_fluid(V& v, Fluid& fluid) {
  v.enter("fluid");
  v.number({"density", "kg/m3", "reference density of the fluid"}, fluid.density, positive);
  v.number({"kinematic_viscosity", "m2/s", "kinematic viscosity of the fluid"}, fluid.kinematic_viscosity,
           not_negative);
  v.text(
      {"velocity_x", "m/s", "velocity at the start, a formula of x, y, z (m) such as \"0.1*sin(2*pi*x)\"; default: 0"},
      fluid.velocity_x);
  v.text({"velocity_y", "m/s", "the same along y"}, fluid.velocity_y);
  v.text({"velocity_z", "m/s", "the same along z"}, fluid.velocity_z);
  v.tables("fill", fluid.fill, [](V& w, FluidFill& fill) {
    w.choice({"kind", "", "up to a level by flood fill, a box, or a closed mesh; default: by the keys given"},
             fill.kind, {"level", "box", "mesh"});
    w.number({"level", "m", "still-water elevation (kind level: required)"}, fill.level, any_number);
    w.optional_point({"seed", "m", "a point [x, y] in the basin, from which the level fill starts"}, fill.seed);
    w.polygon({"polygon", "m", "outline [[x, y], ...] that bounds the basin, and seeds it"}, fill.polygon);
    w.box({"box", "m", "the box filled (kind box)"}, fill.box);
    w.path({"mesh", "", "file of the closed surface filled (kind mesh)"}, fill.mesh);
  });
  v.leave();
}

void describe_terrain(V& v, Terrain& t) {
  v.enter("terrain");
  v.paths({"files", "", "meshes or rasters, merged; `file = \"...\"` when there is one"}, t.files);
  v.number({"scale", "m", "horizontal unit of the files"}, t.scale, positive);
  v.number({"vertical_scale", "m", "vertical unit of the files; negative when they hold depths"}, t.vertical_scale,
           any_number);
  v.number({"vertical_offset", "m", "added to elevations after scaling (datum)"}, t.vertical_offset, any_number);
  v.text({"crs", "", "coordinate system of the files when they do not say, such as \"EPSG:2193\""}, t.crs);
  v.path({"bathymetry", "", "points or raster burned in below the water"}, t.bathymetry);
  v.text({"bathymetry_crs", "", "coordinate system of the bathymetry"}, t.bathymetry_crs);
  v.number({"bathymetry_scale", "m", "vertical unit of the bathymetry; -1 for positive-down depths in metres"},
           t.bathymetry_scale, any_number);
  v.number({"bathymetry_offset", "m", "added to the bathymetry's elevations after scaling"}, t.bathymetry_offset,
           any_number);
  v.choice({"condition", "", "what the fluid feels along the terrain"}, t.condition, wall_conditions);
  v.leave();
}

void describe_wall(V& v, Wall& wall) {
  v.text({"name", "", "name in messages and results; default: wall1, wall2, ..."}, wall.name);
  v.box({"tank", "m", "inner faces of a tank"}, wall.tank);
  v.choices({"open", "", "tank faces left out"}, wall.open, tank_face_names);
  v.choices({"symmetry", "", "tank faces that are planes of symmetry: smooth for grains, free slip for the fluid"},
            wall.symmetry, tank_face_names);
  v.path({"mesh", "", "file of a closed solid, or of an open sheet (made solid downwards)"}, wall.mesh);
  v.number({"mesh_size", "m", "element size when the mesh is a GEO or STEP file; 0: chosen from dp"}, wall.mesh_size,
           not_negative);
  v.number({"scale", "m", "unit of the mesh file"}, wall.scale, positive);
  v.vector({"translate", "m", "shift of the mesh, after scaling"}, wall.translate);
  v.choice({"condition", "", "what the fluid feels along the wall"}, wall.condition, wall_conditions);
}

void describe_slide(V& v, Slide& s) {
  v.text({"name", "", "name in messages and results"}, s.name);
  v.choice({"kind", "", "grains, one rigid body, or a body with prescribed motion"}, s.kind,
           {"granular", "rigid", "prescribed"});
  describe_shape(v, s.shape);
  v.number({"density", "kg/m3", "density of the grains (granular) or of the body"}, s.density, positive);
  v.number({"diameter", "m", "grain diameter (granular: required, or sieve)"}, s.diameter, not_negative);
  v.number({"diameter_deviation", "m", "standard deviation of a normal distribution of diameters"},
           s.diameter_deviation, not_negative);
  v.number({"diameter_half_width", "m",
            "half width of a uniform distribution of diameters (by number), instead of a normal one"},
           s.diameter_half_width, not_negative);
  v.number({"real_diameter", "m", "grain diameter that the drag law sees in coarse-grained runs; 0: the grain's own"},
           s.real_diameter, not_negative);
  v.number({"porosity", "1", "share of voids in the packing"}, s.porosity, share);
  v.integer({"seed", "", "of the random packing"}, s.seed, 0, std::uint64_t{1} << 62);
  v.choice({"relaxation", "",
            "how the packing comes to rest: overlaps moved apart where it is, or falling and settling within the shape "
            "by contact"},
           s.relaxation, {"in-place", "gravity"});
  v.number({"release_at", "s", "held in place before"}, s.release_at, not_negative);
  v.vector({"velocity", "m/s", "velocity at the start"}, s.velocity);
  v.choices({"fixed", "", "motions that the body cannot make (kind rigid)"}, s.fixed, fixed_motions);
  v.path({"motion_csv", "", "file of t,dx,dy,dz (kind prescribed: required)"}, s.motion_csv);
  v.tables("sieve", s.sieve, [](V& w, DiameterClass& c) {
    w.number({"diameter", "m", "grain diameter of this class", true}, c.diameter, positive);
    w.number({"mass_share", "1", "share of this class in the mass; the shares are normalised", true}, c.mass_share,
             positive);
  });
}

void describe_moving(V& v, Scene& scene, const char* kind) {
  std::vector<MovingBody> bodies, others;
  for (MovingBody& body : scene.moving) (body.kind == kind ? bodies : others).push_back(body);
  v.tables(kind, bodies, [kind](V& w, MovingBody& body) {
    body.kind = kind;
    w.text({"name", "", "name in messages and results; default: gate1, piston1, body1, ..."}, body.name);
    describe_shape(w, body.shape);
    w.vector({"velocity", "m/s", "constant velocity between start and stop"}, body.velocity);
    w.number({"start", "s", "time at which the motion starts"}, body.start, not_negative);
    w.number({"stop", "s", "time at which the motion stops"}, body.stop, not_negative);
    w.number({"remove_at", "s", "time at which the body vanishes; < 0: never"}, body.remove_at, any_number);
    w.path({"motion_csv", "", "file of t,dx,dy,dz, instead of velocity"}, body.motion_csv);
    w.choice({"condition", "", "what the fluid feels along the body"}, body.condition, wall_conditions);
    if (body.kind != "piston") return;
    w.enter("wave");
    w.choice({"kind", "", "the wave that the piston makes, instead of velocity and motion_csv"}, body.wave.kind,
             {"none", "solitary"});
    w.number({"height", "m", "height of the crest above still water"}, body.wave.height, not_negative);
    w.number({"depth", "m", "depth of still water at the piston"}, body.wave.depth, not_negative);
    w.vector({"direction", "1", "in which the piston moves at first and the wave runs"}, body.wave.direction);
    w.leave();
    w.enter("far_lake");
    w.number({"length", "m",
              "of a far lake behind the piston, columns of water that move it; 0: none (docs/decisions/0081)"},
             body.far_lake.length, not_negative);
    w.number({"depth", "m", "of the far lake, and of the water that the piston holds, at rest"}, body.far_lake.depth,
             not_negative);
    w.integer({"columns", "", "of the far lake; 0: five a depth"}, body.far_lake.columns, 0, 1000000);
    w.choice({"side", "", "of the piston where the far lake lies"}, body.far_lake.side, {"x+", "x-"});
    w.leave();
  });
  scene.moving = std::move(others);
  scene.moving.insert(scene.moving.end(), bodies.begin(), bodies.end());
}

void describe_floating(V& v, FloatingBody& body) {
  v.text({"name", "", "name in messages and results; default: floating1, floating2, ..."}, body.name);
  describe_shape(v, body.shape);
  v.number({"density", "kg/m3", "mean density of the body"}, body.density, positive);
  v.number({"release_at", "s", "held in place before"}, body.release_at, not_negative);
  v.vector({"velocity", "m/s", "velocity at the start"}, body.velocity);
  v.choices({"fixed", "", "motions that the body cannot make"}, body.fixed, fixed_motions);
}

void describe_contact(V& v, Contact& c) {
  v.enter("contact");
  v.choice({"law", "", "Hertz-Mindlin, or linear spring and dashpot"}, c.law, {"hertz", "linear"});
  v.number({"youngs_modulus", "Pa",
            "of the grains and the walls (law hertz); 0: what keeps overlaps of grains below 1 % of a diameter at rest "
            "and 5 % on impact"},
           c.youngs_modulus, not_negative);
  v.number({"poisson_ratio", "1", "of the grains and the walls (law hertz)"}, c.poisson_ratio, Range{0.0, 0.5, false});
  v.number({"stiffness", "N/m", "normal stiffness (law linear)"}, c.stiffness, positive);
  v.number({"stiffness_ratio", "1", "tangential over normal stiffness (law linear)"}, c.stiffness_ratio, positive);
  v.number({"restitution", "1", "coefficient of restitution"}, c.restitution, Range{0.0, 1.0, true});
  v.number({"friction", "1", "Coulomb coefficient between grains"}, c.friction, not_negative);
  v.number({"wall_friction", "1", "Coulomb coefficient with walls and bodies; < 0: as friction"}, c.wall_friction,
           any_number);
  v.number({"rolling_friction", "1", "rolling resistance coefficient"}, c.rolling_friction, not_negative);
  v.number({"cohesion", "J/m2", "work of adhesion between two grains (DMT), twice the surface energy"}, c.cohesion,
           not_negative);
  v.leave();
}

void describe_coupling(V& v, Coupling& c) {
  v.enter("coupling");
  v.boolean({"enabled", "", "fluid and grains act on each other"}, c.enabled);
  v.choice({"drag", "", "drag law; preset paper: ergun-wen-yu"}, c.drag, {"ergun-wen-yu", "di-felice"});
  v.number({"smoothing_length", "m",
            "of the averaging between grains and fluid; 0: max(3 h, 2 d_max), in the plane max(4 h, 2 d_max)"},
           c.smoothing_length, not_negative);
  v.number({"added_mass", "1", "added-mass coefficient; preset paper: 0"}, c.added_mass, not_negative);
  v.leave();
}

void describe_numerics(V& v, Scene& scene) {
  Numerics& n = scene.numerics;
  v.enter("numerics");
  v.choice({"preset", "", "sets the options below; a key of its own overrides its preset's value"}, n.preset,
           preset_names());
  if (v.reads()) apply_preset(n.preset, scene);
  v.number({"smoothing_ratio", "1", "smoothing length over particle spacing, h / dp; preset paper: 1.3"},
           n.smoothing_ratio, Range{0.5, 4.0, false});
  v.number({"sound_speed", "m/s", "of the weakly compressible fluid; 0: 10 x the largest expected speed"},
           n.sound_speed, not_negative);
  v.number({"expected_speed", "m/s", "largest speed expected; 0: estimated from the scene"}, n.expected_speed,
           not_negative);
  v.choice({"time_scheme", "", "position Verlet split, or the paper's Verlet; preset paper: verlet"}, n.time_scheme,
           {"split", "verlet"});
  v.choice({"walls", "", "wall values extrapolated from the fluid, or dynamic particles; preset paper: dynamic"},
           n.walls, {"extrapolated", "dynamic"});
  v.choice(
      {"wall_layers", "",
       "wall particles of terrain and meshes in even layers along the surface, where no water stands at the start "
       "(fitted-where-dry) or everywhere (fitted; in space as before), or on the cubic lattice; preset paper: lattice"},
      n.wall_layers, {"fitted-where-dry", "fitted", "lattice"});
  v.choice({"viscosity", "", "viscous term of the fluid; preset paper: morris"}, n.viscosity,
           {"artificial", "morris", "none"});
  v.number({"artificial_viscosity", "1", "alpha; preset paper: 0"}, n.artificial_viscosity, not_negative);
  v.number({"density_diffusion", "1", "delta, 0: none; preset paper: 0"}, n.density_diffusion, not_negative);
  v.number({"shifting", "1", "particle shifting coefficient, 0: none; about 20"}, n.shifting, not_negative);
  v.choice({"tension", "",
            "water under tension opens (cavitation), holds without clumping (controlled), or holds (kept); preset "
            "paper: kept"},
           n.tension, {"cavitation", "controlled", "kept"});
  v.number({"cfl", "1", "Courant number; 0: the scheme's own"}, n.cfl, not_negative);
  v.number({"time_step", "s", "fixed time step; 0: adaptive"}, n.time_step, not_negative);
  v.number({"grain_time_step_share", "1", "grain step over the Rayleigh time (hertz) or contact time (linear)"},
           n.grain_time_step_share, Range{0.0, 1.0, true});
  v.boolean({"multirate", "", "grains sub-step inside the fluid's step; preset paper: false"}, n.multirate);
  v.number({"skin", "m", "reach of the neighbour lists past the support; 0: chosen"}, n.skin, not_negative);
  v.leave();
}

void describe_economy(V& v, Economy& e) {
  v.enter("economy");
  v.boolean({"sleep", "", "still water sleeps until it is disturbed; preset paper: false"}, e.sleep);
  v.number({"wake_speed", "sqrt(g dp)", "mean velocity in a block of 8 dp that wakes it"}, e.wake_speed, positive);
  v.boolean({"viscosity", "",
             "viscosity morris is left out where its layer, sqrt(nu t), stays below 0.2 dp; preset paper: false"},
            e.viscosity);
  v.boolean({"near_walls", "", "wall particles away from water are not touched; preset paper: false"}, e.near_walls);
  v.leave();
}

void describe_domain(V& v, Scene& scene) {
  std::optional<Vec3d> lower, upper;
  if (scene.domain) {
    lower = scene.domain->lower;
    upper = scene.domain->upper;
  }
  v.enter("domain");
  v.optional_vector({"lower", "m", "lower corner; default: from the geometry"}, lower);
  v.optional_vector({"upper", "m", "upper corner; default: from the geometry"}, upper);
  v.choices({"periodic", "", "axes along which the domain repeats"}, scene.periodic, {"x", "y", "z"});
  v.choice({"wall_particles", "", "wall particles only where water can come to, or on all terrain and walls"},
           scene.wall_particles, {"reachable", "all"});
  v.number({"run_up", "m",
            "height above the highest water that water may climb (wall_particles reachable); 0: v^2/2g at the expected "
            "speed"},
           scene.run_up, not_negative);
  v.leave();
  if (lower && upper) scene.domain = Box{*lower, *upper};
}

void describe_general(V& v, Scene& scene) {
  v.text({"title", "", "one line for people"}, scene.title);
  std::uint64_t dimensions = static_cast<std::uint64_t>(scene.dimensions);
  v.integer({"dimensions", "", "3, or 2 for the vertical plane x-z (y is ignored)"}, dimensions, 2, 3);
  scene.dimensions = static_cast<int>(dimensions);
  v.vector({"gravity", "m/s2", "acceleration of gravity"}, scene.gravity);
  v.enter("resolution");
  v.number({"dp", "m", "particle spacing", true}, scene.dp, positive);
  v.leave();
}

void describe_places(V& v, Scene& scene) {
  v.tables("gauge", scene.gauges, [](V& w, Gauge& g) {
    w.text({"name", "", "name in results; default: gauge1, gauge2, ..."}, g.name);
    w.place({"at", "m", "[x, y] for the water level, [x, y, z] for the pressure too", true}, g.at, g.has_z);
  });
  v.tables("section", scene.sections, [](V& w, Section& s) {
    w.text({"name", "", "name in results; default: section1, section2, ..."}, s.name);
    w.point({"from", "m", "[x, y] at the section's start", true}, s.from);
    w.point({"to", "m", "[x, y] at the section's end", true}, s.to);
  });
  v.tables("region", scene.regions, [](V& w, Region& r) {
    w.text({"name", "", "name in results; default: region1, region2, ..."}, r.name);
    w.polygon({"polygon", "m", "outline [[x, y], ...]", true}, r.polygon);
  });
}

}  // namespace

void describe_scene(SceneVisitor& v, Scene& scene) {
  describe_general(v, scene);
  describe_domain(v, scene);
  describe_fluid(v, scene.fluid);
  describe_terrain(v, scene.terrain);
  v.tables("wall", scene.walls, describe_wall);
  v.tables("slide", scene.slides, describe_slide);
  for (const char* kind : {"gate", "piston", "body"}) describe_moving(v, scene, kind);
  v.tables("floating", scene.floating, describe_floating);
  describe_contact(v, scene.contact);
  describe_numerics(v, scene);
  describe_coupling(v, scene.coupling);
  describe_economy(v, scene.economy);
  v.enter("time");
  v.number({"end", "s", "simulated time"}, scene.time.end, positive);
  v.number({"output_interval", "s", "simulated time between frames; 0: end / 50"}, scene.time.output_interval,
           not_negative);
  v.leave();
  describe_places(v, scene);
}

const std::vector<std::string>& preset_names() {
  static const std::vector<std::string> names{"accurate", "paper"};
  return names;
}

bool apply_preset(const std::string& preset, Scene& scene) {
  if (preset == "accurate") return true;
  if (preset != "paper") return false;
  Numerics& n = scene.numerics;
  n.time_scheme = "verlet";
  n.walls = "dynamic";
  n.wall_layers = "lattice";
  n.viscosity = "morris";
  n.tension = "kept";
  n.smoothing_ratio = 1.3;
  n.artificial_viscosity = 0.0;
  n.density_diffusion = 0.0;
  n.multirate = false;
  scene.coupling.drag = "ergun-wen-yu";
  scene.coupling.added_mass = 0.0;
  scene.economy.sleep = false;
  scene.economy.viscosity = false;
  scene.economy.near_walls = false;
  return true;
}

}  // namespace gdesp::scene_detail
