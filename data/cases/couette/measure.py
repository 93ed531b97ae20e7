#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Profile of the start-up of plane Couette flow against its series."""
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools

WIDTH, SPEED, VISCOSITY = 1.0e-3, 1.25e-5, 1.0e-6


def exact(z, t):
    speed = SPEED * z / WIDTH
    for n in range(1, 80):
        k = math.pi * n / WIDTH
        speed += 2.0 * SPEED / (n * math.pi) * (-1) ** n * math.sin(k * z) * math.exp(-VISCOSITY * k * k * t)
    return speed


run = tools.run_argument()
rows = tools.Rows()
for time in (0.1, 1.0):
    t, frame = tools.frame_near(run, time)
    errors = [v[0] - exact(r[2], t) for v, r in zip(frame["velocity"], frame["position"])]
    value = tools.root_mean_square(errors) / SPEED
    rows.add(f"profile at {time:g} s, RMS error / speed of the plate", "1", value, 0.0, value, 0.02)
