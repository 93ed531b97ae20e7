# SPDX-License-Identifier: GPL-3.0-or-later
"""Momentum and energy budgets of a run, from its scene and its log."""
import json
import math
from pathlib import Path

import measure_tools as tools
from validation_page import ENERGY, MOMENTUM

ENERGY_BAND, MOMENTUM_BAND = 1e-3, 1e-5
WORKERS = ("gate", "piston", "body")  # tables of a scene that move water from outside


def log_lines(run):
    records = map(json.loads, (Path(run) / "log.ndjson").read_text().splitlines())
    return [record for record in records if "fluid_momentum" in record]


def is_worked_on(scene):
    """Whether something outside the sums gives energy: a driven body, or a period along which gravity pulls."""
    if any(scene.get(name) for name in WORKERS) or any(slide.get("kind") == "prescribed" for slide in scene.get("slide", [])):
        return True
    axes = scene.get("domain", {}).get("periodic", [])
    return any(scene["gravity"]["xyz".index(axis)] != 0.0 for axis in axes)


def is_closed(scene):
    """No walls, no bodies, no gravity: nothing takes momentum or gives it."""
    held = any(scene.get(name) for name in ("wall", "floating", *WORKERS)) or scene.get("terrain", {}).get("files")
    return not held and not any(scene["gravity"]) and not is_worked_on(scene)


def energy_created(lines, spacing_energy):
    """Largest rise of the sum of energies above its least before, over what there was to spend. `spacing_energy`: g dp, m2/s2.

    As the guard of gdesp-run reckons it; a line in which particles have left starts anew."""
    least = before = math.inf
    start = freed = highest = worst = 0.0
    lost = None
    for line in lines:
        potential = sum(line.get(f"{kind}_potential", 0.0) for kind in ("fluid", "grain", "body"))
        total = potential + sum(line.get(f"{kind}_{form}", 0.0) for kind in ("fluid", "grain", "body") for form in ("kinetic", "elastic"))
        gone = line["lost_fluid"] + line["lost_grains"]
        if lost is None:
            start, highest = total - potential, potential
        if gone != lost:
            lost, least, highest = gone, total, potential + freed
        least, freed = min(least, total), max(freed, highest - potential)
        to_spend = start + freed + (line["fluid_mass"] + line["grain_mass"]) * spacing_energy
        if to_spend > 0.0:
            worst = max(worst, (total - least) / to_spend)
    return worst


def momentum_gained(lines):
    """Largest change of the momentum, over mass times the largest speed."""
    def momentum(line):
        return [sum(line.get(f"{kind}_momentum", (0.0, 0.0, 0.0))[a] for kind in ("fluid", "grain", "body")) for a in range(3)]
    first = momentum(lines[0])
    mass = lines[0]["fluid_mass"] + lines[0]["grain_mass"]
    speed = max(max(line["largest_speed"], line["largest_grain_speed"]) for line in lines)
    return max(math.dist(momentum(line), first) for line in lines) / (mass * speed) if mass * speed > 0.0 else math.nan


def budgets(run):
    """Rows as a measure.py prints them: those budgets that can be drawn up for this run."""
    scene, lines = tools.scene(run), log_lines(run)
    found = []
    if not is_worked_on(scene):
        found.append((ENERGY, energy_created(lines, math.hypot(*scene["gravity"]) * scene["resolution"]["dp"]), ENERGY_BAND))
    if is_closed(scene):
        found.append((MOMENTUM, momentum_gained(lines), MOMENTUM_BAND))
    return [{"metric": metric, "unit": "1", "value": f"{value:.3g}", "reference": "0", "error": f"{value:.4g}", "band": f"{band:g}"}
            for metric, value, band in found]
