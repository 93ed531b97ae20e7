#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Front and profile of a dam break against Ritter's solution."""
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools

DEPTH, GRAVITY = 0.3, 9.81
C = math.sqrt(GRAVITY * DEPTH)
SHARE = 1.0 / 20.0  # of the depth, where the front is read
EARLY, LATE = 1.2, 2.4  # s; shallow water holds within the bands from t sqrt(g/h0) = 9 or so on (1.6 s): README.md

run = tools.run_argument()
rows = tools.Rows()


def surface(time):
    rows_ = tools.analyze("profile", run, "--line", "-4.7,0,8.3,0", "--step", "0.02", "--time", str(time))
    return [(row["x"], 0.0 if math.isnan(row["z_surface"]) else row["z_surface"]) for row in rows_]


def front(time):
    for (x0, z0), (x1, z1) in zip(points[time][:-1], points[time][1:]):
        if z0 >= SHARE * DEPTH > z1:
            place = x0 + (x1 - x0) * (z0 - SHARE * DEPTH) / (z0 - z1)
    return place


points = {time: surface(time) for time in (EARLY, LATE)}
speed = (2.0 - 3.0 * math.sqrt(SHARE)) * C
rows.relative(f"speed of the front (depth h0/20), {EARLY} to {LATE} s", "m/s", (front(LATE) - front(EARLY)) / (LATE - EARLY), speed, 0.05)
rows.relative(f"place of the front at {LATE} s", "m", front(LATE), speed * LATE, 0.05)
exact = [(x, (2.0 * C - x / LATE) ** 2 / (9.0 * GRAVITY) if -C * LATE < x < 2.0 * C * LATE else DEPTH * (x < 0.0)) for x, _ in points[LATE]]
tools.picture(run, "profile", "x [m]", f"depth at {LATE} s [m]", {"": points[LATE]}, {"Ritter 1892": exact}, measured=False)
errors = [(z - (2.0 * C - x / LATE) ** 2 / (9.0 * GRAVITY)) / DEPTH for x, z in points[LATE] if -0.9 * C * LATE <= x <= C * LATE]
value = tools.root_mean_square(errors)
rows.add(f"profile at {LATE} s, x/t = -0.9 to 1 sqrt(g h0), RMS / h0", "1", value, 0.0, value, 0.02)
