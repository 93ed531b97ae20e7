#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Slope of the heap that stays: least squares through the highest spheres of slices, from 20 to 80 % of its length."""
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools

run = tools.run_argument()
rows = tools.Rows()
frame = tools.read_vtp(tools.frames(run, "grains")[-1][1])
d = frame["diameter"][0]
top = {}
for r in frame["position"]:
    if 0.2 * 0.30 <= r[0] <= 0.8 * 0.30 and r[2] > 0.0:
        slice_ = math.floor(r[0] / (1.5 * d))
        if r[2] > top.get(slice_, (0.0, -1.0))[1]:
            top[slice_] = (r[0], r[2])
points = list(top.values())
x, z = sum(p[0] for p in points) / len(points), sum(p[1] for p in points) / len(points)
slope = sum((p[0] - x) * (p[1] - z) for p in points) / sum((p[0] - x) ** 2 for p in points)
angle, known = math.degrees(math.atan(-slope)), 29.6 * 10.0 ** -0.206 * (1.0 + math.exp(-0.18 * 4.0))
rows.add("angle of repose", "degree", angle, known, angle - known, 3.0)
speed = max(math.hypot(*v) for v, r in zip(frame["velocity"], frame["position"]) if r[0] < 0.28)
rows.add("fastest sphere of the heap", "m/s", speed, 0.0, speed, 0.02)
