#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Plateau, speed of the bore and profile of the rarefaction against Stoker's solution."""
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools

LEFT, RIGHT, GRAVITY = 0.3, 0.1, 9.81
EARLY, LATE = 2.5, 3.7  # s; shallow water holds within the bands from t sqrt(g/h0) = 17 on (3.0 s): README.md
C = math.sqrt(GRAVITY * LEFT)


def middle():
    """Depth of the plateau, by bisection of the rarefaction's velocity less the bore's."""
    low, high = RIGHT, LEFT
    for _ in range(80):
        h = 0.5 * (low + high)
        u = 2.0 * (C - math.sqrt(GRAVITY * h))
        behind = (h - RIGHT) * math.sqrt(0.5 * GRAVITY * (1.0 / h + 1.0 / RIGHT))
        low, high = (h, high) if u > behind else (low, h)
    return h, u, h * u / (h - RIGHT)


h, u, bore = middle()
run = tools.run_argument()
rows = tools.Rows()


def surface(time):
    rows_ = tools.analyze("profile", run, "--line", "-6.5,0,6.9,0", "--step", "0.02", "--time", str(time))
    return [(row["x"], row["z_surface"]) for row in rows_ if not math.isnan(row["z_surface"])]


def bore_place(time):
    points = surface(time)
    level = 0.5 * (h + RIGHT)
    for (x0, z0), (x1, z1) in zip(reversed(points[:-1]), reversed(points)):
        if z0 >= level > z1:
            return x0 + (x1 - x0) * (z0 - level) / (z0 - z1)
    return math.nan


rows.relative(f"speed of the bore, {EARLY} to {LATE} s", "m/s", (bore_place(LATE) - bore_place(EARLY)) / (LATE - EARLY), bore, 0.05)
points, t = surface(LATE), LATE


def exact(x):
    if x <= -C * t:
        return LEFT
    if x <= (u - math.sqrt(GRAVITY * h)) * t:
        return (2.0 * C - x / t) ** 2 / (9.0 * GRAVITY)
    return h if x <= bore * t else RIGHT


tools.picture(run, "profile", "x [m]", f"depth at {LATE} s [m]", {"": points}, {"Stoker 1957": [(x, exact(x)) for x, _ in points]}, measured=False)
plateau = [z for x, z in points if (u - math.sqrt(GRAVITY * h)) * t + 0.1 <= x <= bore * t - 0.3]
rows.relative(f"depth of the plateau at {LATE} s, mean", "m", sum(plateau) / len(plateau), h, 0.05)
errors = [(z - (2.0 * C - x / t) ** 2 / (9.0 * GRAVITY)) / LEFT for x, z in points if -0.9 * C * t <= x <= (u - math.sqrt(GRAVITY * h)) * t]
value = tools.root_mean_square(errors)
rows.add(f"rarefaction at {LATE} s, RMS / h0", "1", value, 0.0, value, 0.02)
