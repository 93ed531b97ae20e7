#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Velocity of the water at which a bed of beads lifts, against Ergun's pressure drop at the porosity of the bed.

As in the laboratory: the straight line along which the bed grows, carried back to the height of the bed at rest.
"""
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools

FIRST, GAIN = 0.02, 0.05               # m/s, m/s2: motion.csv
FROM, TO = 0.0005, 0.003               # m: growth through which the line is laid
AREA, LOW, HIGH = 0.048 * 0.024, 0.010, 0.030
run = tools.run_argument()
rows = tools.Rows()
scene = tools.scene(run)
rho, nu, g = scene["fluid"]["density"], scene["fluid"]["kinematic_viscosity"], -scene["gravity"][2]
d, rho_s = scene["slide"][1]["diameter"], scene["slide"][1]["density"]


def below(z, r, plane):
    """Volume of a sphere below a plane."""
    depth = min(max(plane - (z - r), 0.0), 2.0 * r)
    return math.pi * depth * depth * (3.0 * r - depth) / 3.0


def bed(path):
    """(porosity between LOW and HIGH, mean height of the beads)."""
    frame = tools.read_vtp(path)
    beads = [r[2] for r, group in zip(frame["position"], frame["group"]) if group == 1]
    solid = sum(below(z, 0.5 * d, HIGH) - below(z, 0.5 * d, LOW) for z in beads)
    return 1.0 - solid / (AREA * (HIGH - LOW)), sum(beads) / len(beads)


curve = [(t, *bed(path)) for t, path in tools.frames(run, "grains")]
eps, rest = min(((e, z) for _, e, z in curve), key=lambda bed: bed[1])
# The mean height rises half as much as the top of the bed.
growth = [(FIRST + GAIN * t, 2.0 * (z - rest)) for t, _, z in curve]
low = min(range(len(growth)), key=lambda k: growth[k][1])
line = [(u, g) for u, g in growth[low:] if FROM <= g <= TO]
mean_u, mean_g = (sum(c) / len(line) for c in zip(*line))
slope = sum((u - mean_u) * (g - mean_g) for u, g in line) / sum((u - mean_u) ** 2 for u, _ in line)
onset = mean_u - mean_g / slope

a, b, c = 1.75 * rho * (1.0 - eps) / (eps ** 3 * d), 150.0 * nu * rho * (1.0 - eps) ** 2 / (eps ** 3 * d * d), (1.0 - eps) * (rho_s - rho) * g
ergun = (math.sqrt(b * b + 4.0 * a * c) - b) / (2.0 * a)
rows.relative(f"velocity at the onset, Ergun at porosity {eps:.3f} ({scene['coupling']['drag']})", "m/s", onset, ergun, 0.05)
archimedes = rho * (rho_s - rho) * g * d ** 3 / (nu * rho) ** 2
rows.stated("velocity at the onset, correlation of Wen and Yu 1966", "m/s", onset, nu / d * (math.sqrt(33.7 ** 2 + 0.0408 * archimedes) - 33.7))
tools.picture(run, "growth", "velocity of the water [m/s]", "growth of the bed [m]", {"bed": growth[low:]}, {"Ergun": [(ergun, 0.0), (ergun, TO)]},
              measured=False, key="top left")
