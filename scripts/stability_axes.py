# SPDX-License-Identifier: GPL-3.0-or-later
"""The axes of scripts/stability-atlas: what is swept, where, what is measured, and when it still holds."""
import dataclasses
import math
import typing

G = 9.81
DAM_SPEED = math.sqrt(2 * G * 0.2)  # m/s: fall over the height of the column


@dataclasses.dataclass
class Axis:
    name: str
    title: str
    parameter: str                  # with its unit in brackets
    values: list
    default: typing.Optional[dict]  # preset -> value; None: no setting of the program, the scene decides
    scene: typing.Callable          # value -> words for atlas_case
    options: typing.Callable        # value, preset -> KEY=VALUE settings of gdesp-run
    metric: str                     # what is plotted, with its unit in brackets
    measure: typing.Callable        # Run -> number
    bound: float                    # holds while the metric stays at or below
    log_x: bool = True
    log_y: bool = True
    presets: tuple = ("accurate", "paper")
    small: tuple = ()               # (a value that holds, a value past the limit or None), for the quick subset
    small_preset: str = "accurate"
    paper_values: tuple = ()        # fewer points for the preset paper, where its runs are long; (): all
    relative: bool = False          # the metric is the relative difference from the first value's
    variants: tuple = ((),)         # words added to the scene; the worst counts

    def values_for(self, preset):
        return list(self.paper_values) if preset == "paper" and self.paper_values else self.values


def energy_rise(run):
    """% of what there was to spend, as the guard of gdesp-run reckons it (EnergyWatch in tools/gdesp-run/guard.hpp)."""
    least, freed, highest, start, before, worst = math.inf, 0.0, 0.0, 0.0, 0.0, 0.0
    lost, step = None, 0
    for line in run.log:
        if lost is not None and line["step"] - step < 50:
            continue
        step = line["step"]
        potential = sum(line[f"{phase}_potential"] for phase in ("fluid", "grain", "body"))
        total = potential + sum(line[f"{phase}_{kind}"] for phase in ("fluid", "grain", "body") for kind in ("kinetic", "elastic"))
        gone = line["lost_fluid"] + line["lost_grains"]
        if lost is None:
            start, highest = total - potential, potential
        if gone != lost:
            lost, least, before, highest = gone, total, total, potential + freed
        least, freed = min(least, max(total, before)), max(freed, highest - potential)
        to_spend = start + freed + (line["fluid_mass"] + line["grain_mass"]) * run.spacing_energy
        if to_spend > 0:
            worst = max(worst, (min(total, before) - least) / to_spend)
        before = total
    return 100 * worst


def largest(name, factor=1.0):
    return lambda run: factor * max(line[name] for line in run.log)


def last(name, factor=1.0):
    return lambda run: factor * run.log[-1][name]


def smallest_distance(run):
    """Of two particles in the last frame, over their spacing."""
    points, cells, least = run.points(-1, "fluid"), {}, math.inf
    for x, _, z in points:
        i, k = math.floor(x / run.dp), math.floor(z / run.dp)
        for di in (-1, 0, 1):
            for dk in (-1, 0, 1):
                for u, w in cells.get((i + di, k + dk), ()):
                    least = min(least, math.hypot(x - u, z - w))
        cells.setdefault((i, k), []).append((x, z))
    return run.dp / least


def sheet_speed_error(run):
    """%: speed of the sheet along the slope against g sin(angle) t."""
    line = run.log[-1]
    speed = math.hypot(line["fluid_momentum"][0], line["fluid_momentum"][2]) / line["fluid_mass"]
    return 100 * abs(speed / (G * math.sin(math.radians(30)) * line["t"]) - 1)


def settling_error(run):
    """%: speed of one grain after 0.2 s against m v' = (m - m_f) g - drag (Di Felice at porosity 1) - m_f v'/2."""
    d, density, water, viscosity = run.value * 0.015, 2650.0, 1000.0, 1.0e-3
    volume = math.pi * d ** 3 / 6
    added = 0.5 * water * volume if run.preset == "accurate" else 0.0
    v, steps = 0.0, 4000
    for _ in range(steps):
        reynolds = max(water * v * d / viscosity, 1e-9)
        drag = (0.63 + 4.8 / math.sqrt(reynolds)) ** 2 * math.pi * d * d * water * v * v / 8
        v += run.log[-1]["t"] / steps * ((density - water) * volume * G - drag) / (density * volume + added)
    line = run.log[-1]
    return 100 * abs(-line["grain_momentum"][2] / line["grain_mass"] / v - 1)


def went_through(run):
    """1 when the grain is inside or behind the wall at the end, else 0."""
    points, target = run.points(-1, "grains"), int(run.words.get("target", 0))
    if not points:
        return 0.0 if run.log[-2]["grain_momentum"][0] < 0 else 1.0
    x, y, z = points[0]
    depth = {0: x - 0.5, 3: x - 0.5, 1: (x - 0.5) - abs(z), 2: (x - 0.5) - max(abs(y), abs(z))}[target]
    return 1.0 if depth > 0.005 else 0.0


def creep(run):
    """mm/s, of grains that should rest."""
    return 1000 * run.log[-1]["largest_grain_speed"]


def axis_list():
    none = lambda value, preset: []
    setting = lambda key: lambda value, preset: [f"{key}={value:.9g}"]
    word = lambda *words: lambda value: [w.format(v=value) for w in words]
    return [
        Axis("cfl", "Courant number (step fixed at that share of h/c)", "c dt / h [1]", [0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.4, 2.0, 3.0, 5.0, 8.0],
             {"accurate": 0.5, "paper": 0.2}, word("dam", "dp=0.005"),
             lambda v, preset: [f"numerics.time_step={v * 0.005 * (1.3 if preset == 'paper' else 1.5) / (10 * DAM_SPEED):.6g}"], "energy that nothing gave [%]",
             energy_rise, 5.0, small=(0.5, 8.0)),
        Axis("sound-speed", "Sound speed too low for the flow", "sound speed / largest expected speed [1]",
             [1.0, 1.5, 2, 3, 5, 7, 10, 15, 20], {"accurate": 10, "paper": 10}, word("dam", "dp=0.005"),
             lambda v, preset: [f"numerics.sound_speed={v * DAM_SPEED:.6g}"], "largest density error [%]",
             largest("largest_density_error", 100), 10.0, small=(10, 1.0)),
        Axis("tension", "Negative pressure: rotating square patch", "angle turned [rad]", [0.25, 0.5, 1, 1.5, 2, 3, 4], None,
             word("patch", "dp=0.025", "end={v}"), none, "spacing / smallest distance of two particles [1]", smallest_distance, 4.0),
        Axis("thin-sheet", "Thin sheet on a dry slope of 30 degrees", "layers of particles [1]", [1, 2, 3, 4, 6, 8, 12], None,
             word("sheet", "layers={v}"), none, "speed against free sliding, off by [%]", sheet_speed_error, 10.0),
        Axis("impact", "Water thrown at a wall", "speed [m/s]", [1, 3, 10, 30, 100, 200, 300], None, word("dam", "speed={v}", "end=0.05"),
             none, "energy that nothing gave [%]", energy_rise, 5.0, small=(100, None)),
        Axis("jagged-bed", "Still water over a jagged bed, 5 s", "height of the teeth / spacing [1]", [0, 1, 2, 3, 4, 6, 8], None,
             lambda v: ["still", f"tooth={v * 0.01}"], none, "speed at the end / sqrt(g depth) [%]",
             lambda run: 100 * run.log[-1]["largest_speed"] / math.sqrt(G * 0.1), 5.0, log_x=False),
        Axis("grain-density", "Grains lighter and heavier than water", "density of the grains / of water [1]",
             [0.25, 0.5, 0.8, 1.0, 1.5, 2.65, 4, 8, 16], None, lambda v: ["wet", f"density={1000 * v}"], none,
             "energy that nothing gave [%]", energy_rise, 5.0, small=(2.65, None), paper_values=(0.5, 2.65)),
        Axis("stiff-drag", "Drag that relaxes far below the step", "diameter that drag sees [m]",
             [1e-2, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6], None, word("wet", "real_diameter={v}"), none,
             "energy that nothing gave [%]", energy_rise, 5.0, paper_values=(1e-2, 1e-6)),
        Axis("grain-size", "Grain diameter against smoothing length", "diameter / h [1]", [0.2, 0.35, 0.5, 0.75, 1, 1.5, 2, 3, 4], None,
             lambda v: ["settle", f"diameter={v * 0.015}"], none, "settling speed after 0.2 s, off by [%]", settling_error, 10.0,
             presets=("accurate",)),
        Axis("pores", "Pores that close", "porosity of the bed of discs at the start [1]",
             [0.7, 0.6, 0.5, 0.4, 0.35, 0.3, 0.25, 0.2, 0.15], None,
             lambda v: ["pores", f"gap={math.sqrt(0.9027 / (1 - v)):.6g}"], none, "energy that nothing gave [%]", energy_rise, 5.0, log_x=False,
             paper_values=(0.5, 0.3)),
        Axis("grain-step", "Step of the grains", "numerics.grain_time_step_share [1]", [0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.7, 1.0],
             {"accurate": 0.2, "paper": 0.2}, word("heap", "end=0.3"), setting("numerics.grain_time_step_share"), "energy that nothing gave [%]",
             energy_rise, 5.0, presets=("accurate",)),
        Axis("restitution", "Restitution: energy never grows", "contact.restitution [1]", [0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 0.9, 0.95, 1.0],
             {"accurate": 0.5}, word("heap", "end=0.3"), setting("contact.restitution"), "energy that nothing gave [%]", energy_rise, 5.0,
             log_x=False, presets=("accurate",)),
        Axis("youngs-modulus", "Young's modulus of the grains", "contact.youngs_modulus [Pa]",
             [3e4, 1e5, 3e5, 1e6, 3e6, 1e7, 1e8], None, word("heap", "drop=0.2", "end=0.3"),
             setting("contact.youngs_modulus"), "largest overlap / diameter [%]", largest("largest_overlap", 100), 10.0,
             presets=("accurate",), small=(1e7, 3e4)),
        Axis("size-ratio", "Largest over smallest grain", "ratio of diameters [1]", [1, 2, 3, 5, 7, 10, 15, 20], None,
             word("heap", "ratio={v}", "end=0.25", "high=4"), lambda v, preset: ["contact.youngs_modulus=1e6"], "energy that nothing gave [%]", energy_rise, 5.0, presets=("accurate",)),
        Axis("shot", "A grain shot at a plate, an edge, a vertex, a thin gate", "speed [m/s]", [1, 10, 30, 100, 300, 1000], None,
             word("shot", "speed={v}"), lambda v, preset: ["contact.youngs_modulus=7e10"], "went through (1: yes)", went_through, 0.5, log_y=False, presets=("accurate",),
             small=(100, None), variants=tuple((f"target={k}",) for k in range(4))),
        Axis("light-body", "A box, ten spacings wide, lighter than water: let go half-sunk, and at the bottom", "density of the box / of water [1]",
             [0.01, 0.02, 0.03, 0.05, 0.1, 0.2, 0.3, 0.5, 0.8, 1.0], None, word("float", "ratio={v}"), none, "energy that nothing gave [%]", energy_rise,
             5.0, small=(0.2, None), variants=((), ("sunk=1",))),
        Axis("resting", "Grains at rest on a slope (friction 0.5: 26.6 degrees)", "angle of the slope [degree]",
             [0, 5, 10, 15, 20, 24, 26, 27, 30, 35], None, word("slope", "angle={v}", "end=1"), none, "speed after 1 s [mm/s]", creep, 0.1,
             log_x=False, presets=("accurate",), small=(20, None)),
        Axis("coordinates", "Coordinates far from the origin", "distance from the origin [m]", [0, 1e3, 1e4, 1e5, 1e6, 5e6], None,
             word("dam", "end=0.2", "offset={v}"), none, "kinetic energy after 0.2 s, off by [%]", last("fluid_kinetic"), 1.0,
             relative=True, log_x=False, small=()),
        Axis("leaving", "Water that leaves the domain: mass that is neither there nor counted as lost", "right wall open [0 or 1]", [0, 1],
             None, word("dam", "open={v:.0f}"), none, "mass unaccounted for [%]",
             lambda run: 100 * abs(sum((run.log[-1]["fluid_mass"], 1000 * run.dp ** 2 * run.log[-1]["lost_fluid"])) /
                                   run.log[0]["fluid_mass"] - 1), 1e-3, log_x=False, small=(1, None)),
    ]
