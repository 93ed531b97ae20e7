#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Front of the collapsing column (the outermost grain of the heap that is 3 mm high) against the measured one."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools

run = tools.run_argument()
rows = tools.Rows()
kind = "loose" if tools.scene(run)["slide"][0]["porosity"] > 0.42 else "dense"
measured = [(row["t"], 1.0e-3 * row["front"]) for row in tools.reference("rondon_2011_fronts") if row["case"] == kind]
curve = []
for t, path in tools.frames(run, "grains"):
    curve.append((t, tools.connected_front(tools.read_vtp(path), depth=0.003)))
times, fronts = [t for t, _ in curve], [x for _, x in curve]
for t, x in measured:
    if 0.5 <= t <= min(times[-1], 3.3):
        rows.relative(f"front at {t:g} s, {kind}", "m", tools.at(t, times, fronts), x, 0.1)
tools.picture(run, f"front-{kind}", "time [s]", "front [m]", {"heap": curve}, {"Rondon et al. 2011": measured}, key="bottom right")
