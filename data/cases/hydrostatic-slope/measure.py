#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Still water: pressure error of all particles, largest spurious speed, particles lost."""
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools

run = tools.run_argument()
rows = tools.Rows()
DEPTH, GRAVITY, DENSITY = 0.2, 9.81, 1000.0

speed = pressure = mean = 0.0
for time, path in tools.frames(run):
    if time < 1.0:
        continue
    frame = tools.read_vtp(path)
    speed = max(speed, max(math.hypot(*v) for v in frame["velocity"]))
    errors = [p / (DENSITY * GRAVITY * DEPTH) - 1.0 + r[2] / DEPTH for p, r in zip(frame["pressure"], frame["position"])]
    pressure = max(pressure, max(map(abs, errors)))
    mean = tools.root_mean_square(errors)
rows.add("largest pressure error from 1 s on / (rho g H)", "1", pressure, 0.0, pressure, 0.02)
rows.add("RMS pressure error / (rho g H) at the end", "1", mean, 0.0, mean, 0.01)
rows.add("largest spurious speed from 1 s on / sqrt(g H)", "1", speed / math.sqrt(GRAVITY * DEPTH), 0.0,
         speed / math.sqrt(GRAVITY * DEPTH), 0.005)
lost = tools.last_log(run)["lost_fluid"]
rows.add("particles lost", "1", lost, 0, lost, 0)
