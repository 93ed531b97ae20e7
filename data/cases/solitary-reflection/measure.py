#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Height, speed and run-up at a vertical wall of a solitary wave."""
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools

DEPTH, HEIGHT, GRAVITY = 0.3, 0.06, 9.81

run = tools.run_argument()
rows = tools.Rows()
gauges = {}
for row in tools.analyze("gauge", run):
    gauges.setdefault(row["gauge"], []).append((row["t"], row["rise"]))


def crest(curve):
    """Time and height of the highest point, by the parabola through it and its neighbours two frames away."""
    k = max(range(2, len(curve) - 2), key=lambda n: curve[n][1])
    (t0, a), (t1, b), (t2, c) = curve[k - 2], curve[k], curve[k + 2]
    bend = a - 2.0 * b + c
    offset = 0.5 * (a - c) / bend if bend < 0.0 else 0.0
    return t1 + offset * (t2 - t1), b - 0.25 * (a - c) * offset


first = {name: crest([(t, z) for t, z in gauges[name] if t < 4.0]) for name in ("near", "far")}
height = first["far"][1]
e = height / DEPTH
rows.relative("height of the wave 10 d from the piston", "m", height, HEIGHT, 0.05)
speed = 1.2 / (first["far"][0] - first["near"][0])
rows.relative("speed of the wave", "m/s", speed, math.sqrt(GRAVITY * DEPTH) * (1 + e / 2 - 3 * e * e / 20 + 3 * e ** 3 / 56), 0.02)
rows.relative("run-up at the wall, R/d", "1", crest(gauges["wall"])[1] / DEPTH, 2 * e + e * e / 2 + 0.75 * e ** 3, 0.03)
