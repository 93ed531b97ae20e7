#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Fronts of water and beads of the two-phase dam break: arrival at the far wall, and which of them leads.

The curves that Sun et al. 2013 measured are in a figure only, so the fronts are stated. What the paper says in words is judged:
the front of the water is ahead of that of the beads, both in the experiment and in its run.
"""
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools

LENGTH, WALL = 0.05, 0.2     # m: H of x* = x/H and t* = t (2 g/H)^(1/2), paper, equations 19 and 20
REACHED = WALL - 0.003       # m
run = tools.run_argument()
rows = tools.Rows()
rate = math.sqrt(2.0 * 9.8 / LENGTH)
table = tools.analyze("front", run)
curves = {"water": [(row["t"], row["x_front"]) for row in table], "beads": [(row["t"], row["x_solids"]) for row in table]}


def arrival(curve):
    """Time at which a front comes to the far wall, s."""
    for (t0, x0), (t1, x1) in zip(curve, curve[1:]):
        if x1 >= REACHED > x0:
            return t0 + (t1 - t0) * (REACHED - x0) / (x1 - x0)
    return math.nan


for name, curve in curves.items():
    rows.stated(f"front of the {name} at the far wall, t*", "1", arrival(curve) * rate, "not published as a number")
    rows.stated(f"front of the {name} at t* = 2, x/H", "1", tools.at(2.0 / rate, *zip(*curve)) / LENGTH, "not published as a number")
water = dict(curves["water"])
running = [water[t] - x for t, x in curves["beads"] if x > 1.2 * LENGTH and water[t] < REACHED]
behind = -min(running, default=math.nan) / LENGTH
rows.add("how far the beads are ahead of the water, at most, while both run / H", "1", max(behind, 0.0), 0.0, max(behind, 0.0), 0.05)
tools.picture(run, "fronts", "t (2 g/H)^{1/2}", "x/H",
              {name: [(t * rate, x / LENGTH) for t, x in curve] for name, curve in curves.items()}, {}, key="bottom right")
