#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Largest crest, and crests along the channel, against the formulas of Heller and Hager for a channel.

P = F S^(1/2) M^(1/4) cos(6 alpha/7)^(1/2); a_M/h = 4/9 P^(4/5); a(X)/h = 3/5 (P X^(-1/3))^(4/5) beyond X_M = 11/2 P^(1/2).
The slide's speed is what it is when its centre is half its length above the water; mass and thickness are the scene's.
"""
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools

DEPTH, THICKNESS, ANGLE, G, EDGE = 0.3, 0.15, math.radians(45.0), 9.81, -0.3
run = tools.run_argument()
rows = tools.Rows()
first = tools.read_vtp(tools.frames(run, "grains")[0][1])
mass = sum(math.pi / 4.0 * d * d * rho for d, rho in zip(first["diameter"], first["density"]))
speed = math.hypot(*first["velocity"][0])
F, S, M = speed / math.sqrt(G * DEPTH), THICKNESS / DEPTH, mass / (1000.0 * DEPTH ** 2)
P = F * S ** 0.5 * M ** 0.25 * math.cos(6.0 * ANGLE / 7.0) ** 0.5
crest = {}
for row in tools.analyze("gauge", run):
    crest[row["gauge"]] = max(crest.get(row["gauge"], 0.0), row["rise"])
rows.relative(f"largest crest a_M / h", "1", crest["near"] / DEPTH, 4.0 / 9.0 * P ** 0.8, 0.4)
for name, x in (("middle", 2.1), ("far", 3.3)):
    X = (x - EDGE) / DEPTH
    rows.relative(f"crest at X = {X:.0f} / h", "1", crest[name] / DEPTH, 0.6 * (P * X ** (-1.0 / 3.0)) ** 0.8, 0.4)
