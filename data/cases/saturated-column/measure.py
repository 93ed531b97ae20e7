#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Radii of the fronts of water and of grains against the spread of three repeats seen by two cameras.

A front is the radius beyond which 1 % of the grains or of the water lies. The tube of the experiment is lifted, here it
vanishes: one constant shift of time, up to 0.05 s, is taken out. The error is what lies outside the spread of the repeats,
over the mean.
"""
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools

run = tools.run_argument()
rows = tools.Rows()
measured = tools.reference("webb_2024_saturated_column")


def fronts(kind):
    out = []
    for t, path in tools.frames(run, kind):
        frame = tools.read_vtp(path)
        radii = sorted(math.hypot(r[0], r[1]) for r in frame["position"])
        edge = 0.5 * (frame["diameter"][0] if kind == "grains" else frame["dp"][0] if "dp" in frame else DP)
        out.append((t, radii[min(len(radii) - 1, int(0.99 * len(radii)))] + edge))
    return [t for t, _ in out], [r for _, r in out]


DP = tools.scene(run)["resolution"]["dp"]
curves = {"water": fronts("fluid"), "grains": fronts("grains")}


def outside(name, shift):
    times, radii = curves[name]
    errors = []
    for row in measured:
        if row["t"] - shift <= times[-1]:
            r, low, high = tools.at(row["t"] - shift, times, radii), row[f"r_{name}_low"], row[f"r_{name}_high"]
            errors.append((max(0.0, r - high) - max(0.0, low - r)) / row[f"r_{name}_mean"])
    return errors


shift = min((0.005 * k for k in range(11)), key=lambda s: sum(e * e for n in curves for e in outside(n, s)))
for name in curves:
    value = max(outside(name, shift), key=abs)
    times, radii = curves[name]
    last = [row for row in measured if row["t"] - shift <= times[-1]][-1]
    r = tools.at(last["t"] - shift, times, radii)
    rows.add(f"front of the {name} at {last['t']:g} s; error: largest distance outside the repeats, over the mean", "m", r,
             f"{last[f'r_{name}_mean']:g} ({last[f'r_{name}_low']:g} to {last[f'r_{name}_high']:g})", value, 0.05)
rows.add("shift of time", "s", shift, 0.0, shift, 0.05)
