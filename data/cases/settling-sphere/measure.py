#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Velocity of a sinking sphere against the measured one, until the floor brakes it (gap of two diameters, 2.7 s)."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools

run = tools.run_argument()
rows = tools.Rows()
measured = [(row["t"], row["velocity"]) for row in tools.reference("ten_cate_2002_sphere_e1") if row["t"] <= 2.7]
curve = [(t, tools.read_vtp(path)["velocity"][0][2]) for t, path in tools.frames(run, "grains")]
times, speeds = [t for t, _ in curve], [v for _, v in curve]


def steady(points):
    inside = [v for t, v in points if 1.0 <= t <= 2.5]
    return sum(inside) / len(inside)


rows.relative("steady velocity, mean of 1 to 2.5 s", "m/s", steady(curve), steady(measured), 0.05)
misfit = tools.root_mean_square(tools.at(t, times, speeds) - v for t, v in measured) / abs(steady(measured))
rows.add("velocity until 2.7 s, RMS misfit / steady velocity", "1", misfit, 0.0, misfit, 0.1)
tools.picture(run, "velocity", "time [s]", "velocity [m/s]", {"sphere": curve}, {"ten Cate et al. 2002": measured})
