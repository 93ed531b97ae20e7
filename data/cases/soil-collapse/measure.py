#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Final surface of the heap of rods against the measured one: run-out, profile, height that is left at the wall."""
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools

LENGTH, HEIGHT = 0.20, 0.10
TOE = 0.005   # m: the heap ends where it is lower; four rods, so that single rods in front do not count
run = tools.run_argument()
rows = tools.Rows()
frame = tools.frame_near(run, 1e9, "grains")[1]
floor = max((r[2] + 0.5 * d for r, d, group in zip(frame["position"], frame["diameter"], frame["group"]) if group == 1), default=0.0)
rods = [(r[0], r[2] - floor, 0.5 * d) for r, d, group in zip(frame["position"], frame["diameter"], frame["group"]) if group == 0]
width = max(0.01, 4.0 * max(radius for _, _, radius in rods))


def surface(x):
    """Top of the rods, mean over a window around x."""
    near = [rod for rod in rods if abs(rod[0] - x) < 0.5 * width + rod[2]]
    tops = []
    for k in range(41):
        at = max(x + (k / 40.0 - 0.5) * width, 0.0)
        tops.append(max((z + math.sqrt(r * r - (c - at) ** 2) for c, z, r in near if abs(c - at) < r), default=0.0))
    return sum(tops) / len(tops)


def toe(curve):
    """Where the surface comes down to TOE for the last time."""
    last = max(k for k, (_, z) in enumerate(curve) if z >= TOE)
    (x0, z0), (x1, z1) = curve[last:last + 2]
    return x0 + (x1 - x0) * (z0 - TOE) / (z0 - z1)


measured = [(row["x"], row["surface"]) for row in tools.reference("bui_2008_soil_collapse")]
curve = [(x, surface(x)) for x in (0.002 * k for k in range(300))]
xs, zs = zip(*curve)
rows.relative("run-out of the heap, 5 mm high, (L - L0)/L0", "1", toe(curve) / LENGTH - 1.0, toe(measured) / LENGTH - 1.0, 0.05)
misfit = tools.root_mean_square(tools.at(x, xs, zs) - z for x, z in measured) / HEIGHT
rows.add("surface, RMS misfit / height of the heap", "1", misfit, 0.0, misfit, 0.05)
rows.relative("height left at the wall", "m", surface(0.02), tools.at(0.02, *zip(*measured)), 0.05)
overlap = tools.last_log(run)["largest_overlap"]
rows.add("largest overlap / diameter at the end", "1", overlap, 0.0, overlap, 0.01)
tools.picture(run, "surface", "x [m]", "height [m]", {"rods": curve}, {"Bui et al. 2008": measured})
