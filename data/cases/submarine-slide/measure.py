#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Water surface at two gauges against the measured one, while the block is on the straight slope."""
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools

run = tools.run_argument()
rows = tools.Rows()
measured = tools.reference("sue_2011_submarine_gauges")
table = tools.analyze("gauge", run)
for gauge in ("x0.5", "x1.5"):
    times = [row["t"] for row in table if row["gauge"] == gauge]
    rises = [row["rise"] for row in table if row["gauge"] == gauge]
    seen = [(row["t"], row[gauge]) for row in measured if row["t"] <= times[-1]]
    extreme = max((z for _, z in seen), key=abs)
    found = (max if extreme > 0.0 else min)(rises)
    rows.relative(f"{'crest' if extreme > 0.0 else 'trough'} at {gauge[1:]} m", "m", found, extreme, 0.1)
    misfit = tools.root_mean_square(tools.at(t, times, rises) - z for t, z in seen)
    rows.add(f"surface at {gauge[1:]} m, RMS misfit / measured extreme", "1", misfit / abs(extreme), 0.0, misfit / abs(extreme), 0.1)

# run-down: the water line on the slope, half a spacing beyond the particle nearest to the shore
dp = tools.scene(run)["resolution"]["dp"]
lowest = min(range(len(tools.frames(run))), key=lambda k: abs(tools.frames(run)[k][0] - 0.87))
place = tools.read_vtp(tools.frames(run)[lowest][1])["position"]
line = min(x for x, _, _ in place) - 0.5 * dp
rows.relative("run-down at the shore, 0.87 s", "m", -line * math.tan(math.radians(15.0)), -0.00981, 0.1)
