#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Height, speed and run-up at a vertical wall of a solitary wave."""
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools

DEPTH, HEIGHT, GRAVITY = 0.3, 0.06, 9.81
RUN_UP = DEPTH * (2 * 0.2 + 0.2 ** 2 / 2 + 0.75 * 0.2 ** 3)  # m, of the wave as ordered

run = tools.run_argument()
rows = tools.Rows()
gauges = {}
for row in tools.analyze("gauge", run):
    gauges.setdefault(row["gauge"], []).append((row["t"], row["rise"]))
tools.picture(run, "gauges", "t [s]", "rise at 10 d from the piston and at the wall [m]", {"far": gauges["far"], "wall": gauges["wall"]},
              {"theory: 2 e + e^2/2 + 3 e^3/4": [(0.0, RUN_UP), (gauges["wall"][-1][0], RUN_UP)]}, measured=False, key="top left")
first = {name: tools.crest([(t, z) for t, z in gauges[name] if t < 4.0]) for name in ("near", "far")}
height = first["far"][1]
e = height / DEPTH
rows.relative("height of the wave 10 d from the piston", "m", height, HEIGHT, 0.05)
speed = 1.2 / (first["far"][0] - first["near"][0])
rows.relative("speed of the wave", "m/s", speed, math.sqrt(GRAVITY * DEPTH) * (1 + e / 2 - 3 * e * e / 20 + 3 * e ** 3 / 56), 0.02)
rows.relative("run-up at the wall, R/d", "1", tools.crest(gauges["wall"])[1] / DEPTH, 2 * e + e * e / 2 + 0.75 * e ** 3, 0.03)
