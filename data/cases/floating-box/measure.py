#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draught and angle of a floating box at rest, against Archimedes."""
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools

run = tools.run_argument()
rows = tools.Rows()
scene = tools.scene(run)
floating, water = scene["floating"][0], scene["fluid"]["density"]
height = floating["box"]["upper"][2] - floating["box"]["lower"][2]

frames = tools.frames(run, "bodies")
last = [(t, path) for t, path in frames if t >= frames[-1][0] - 1.0]
states = [tools.read_vtp(path) for _, path in last]
bottom = sum(s["body_centre"][2] for s in states) / len(states) - 0.5 * height
levels = [row["level"] for row in tools.analyze("gauge", run) if row["t"] >= last[0][0] - 1e-9]
draught = sum(levels) / len(levels) - bottom
ratio = floating["density"] / water
rows.add("draught / height", "1", draught / height, ratio, draught / height - ratio, 0.02)
angle = max(2.0 * math.degrees(math.asin(min(1.0, abs(s["body_orientation"][2])))) for s in states)
rows.add("largest angle in the last second", "degree", angle, 0.0, angle, 2.0)
