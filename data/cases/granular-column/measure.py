#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Run-out of the connected deposit over the column's length, against 1.2 a and 1.9 a^(2/3) (Lube et al. 2005)."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools

LENGTH, RELEASE = 0.10, 0.2
run = tools.run_argument()
rows = tools.Rows()
start, end = tools.frame_near(run, RELEASE, "grains")[1], tools.frame_near(run, 1e9, "grains")[1]
top = sorted(r[2] + 0.5 * d for r, d in zip(start["position"], start["diameter"]))
height = top[int(0.98 * len(top))]
a = height / LENGTH
front = tools.connected_front(end, depth=1.5 * max(end["diameter"]))
law = 1.2 * a if a < 2.3 else 1.9 * a ** (2.0 / 3.0)
rows.relative(f"run-out (L - L0)/L0 at a = {a:.2f}", "1", front / LENGTH - 1.0, law, 0.15)
rest = max(sum(c * c for c in v) ** 0.5 for v, r in zip(end["velocity"], end["position"]) if r[0] < front)
rows.add("fastest grain of the deposit / sqrt(g H)", "1", rest / (9.81 * height) ** 0.5, 0.0, rest / (9.81 * height) ** 0.5, 0.05)
