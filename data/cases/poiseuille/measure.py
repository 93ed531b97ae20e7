#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Profile of the start-up of plane Poiseuille flow against its series."""
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools

WIDTH, FORCE, VISCOSITY = 1.0e-3, 1.0e-4, 1.0e-6
PEAK = FORCE * WIDTH ** 2 / (8.0 * VISCOSITY)


def exact(z, t):
    speed = FORCE / (2.0 * VISCOSITY) * z * (WIDTH - z)
    for n in range(60):
        k = math.pi * (2 * n + 1) / WIDTH
        speed -= 4.0 * FORCE / (VISCOSITY * WIDTH * k ** 3) * math.sin(k * z) * math.exp(-VISCOSITY * k * k * t)
    return speed


run = tools.run_argument()
rows = tools.Rows()
for time in (0.1, 1.0):
    t, frame = tools.frame_near(run, time)
    errors = [v[0] - exact(r[2], t) for v, r in zip(frame["velocity"], frame["position"])]
    value = tools.root_mean_square(errors) / PEAK
    rows.add(f"profile at {time:g} s, RMS error / highest speed", "1", value, 0.0, value, 0.02)
rows.relative("highest speed at 1 s", "m/s", max(v[0] for v in frame["velocity"]), max(exact(r[2], t) for r in frame["position"]), 0.02)
