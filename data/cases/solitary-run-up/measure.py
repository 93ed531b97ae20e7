#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Height of the solitary wave half its length before the beach, and its run-up against the law of Synolakis 1987."""
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools

DEPTH, HEIGHT, COTANGENT, GRAVITY = 0.3, 0.03, 5.0, 9.81

run = tools.run_argument()
rows = tools.Rows()
# The crest passes the gauge long before the reflected wave is back.
_, height = tools.crest([(row["t"], row["rise"]) for row in tools.analyze("gauge", run) if row["gauge"] == "offshore" and row["t"] < 5.0])
rows.relative("height of the wave half its length before the toe", "m", height, HEIGHT, 0.05)
climb = [row for row in tools.analyze("runup", run) if row["x"] > 4.0 or math.isnan(row["x"])]
run_up = max(row["run_up"] for row in climb)
rows.relative("run-up, R/d", "1", run_up / DEPTH, 2.831 * math.sqrt(COTANGENT) * (height / DEPTH) ** 1.25, 0.05)
history = {}
for row in climb:
    if not math.isnan(row["run_up"]):
        history[row["t"]] = max(history.get(row["t"], -1.0), row["run_up"] / DEPTH)
expected = 2.831 * math.sqrt(COTANGENT) * (height / DEPTH) ** 1.25
tools.picture(run, "run-up", "t [s]", "height of the water's tip above still water / d", {"": sorted(history.items())},
              {"largest, Synolakis 1987, wave as measured": [(t, expected) for t in (0.0, 8.0)]}, measured=False, key="top left")
