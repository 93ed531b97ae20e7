#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Surface and front of the wet-bed dam break of Janosi et al. 2004."""
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools

BED, LEVEL = 0.038, 0.05  # m: depth of the channel; height at which the front is read
LATE = 0.406  # s, of the picture

run = tools.run_argument()
rows = tools.Rows()
measured = {}
for row in tools.reference("janosi_2004_wet_bed"):
    measured.setdefault(row["t"], []).append((row["x"], row["z"]))
squares, fronts = [], []
for time, points in sorted(measured.items()):
    table = tools.analyze("profile", run, "--line", "0.3,0,1.3,0", "--step", "0.005", "--time", str(time))
    surface = [(row["x"], row["z_surface"]) for row in table if not math.isnan(row["z_surface"])]
    xs, zs = [x for x, _ in surface], [z for _, z in surface]
    if abs(time - LATE) < 0.01:
        tools.picture(run, "surface", "x [m]", f"surface at {time:g} s [m]", {"": surface}, {"Janosi et al. 2004": sorted(points)})
    squares += [(tools.at(x, xs, zs) - z) ** 2 for x, z in points]
    fronts.append((time, max(x for x, z in surface if z > LEVEL), max(x for x, z in points if z > LEVEL)))
value = math.sqrt(sum(squares) / len(squares))
rows.add("surface at eight times, RMS", "m", value, 0.0, value, 0.01)
late = [f for f in fronts if f[0] > 0.25]
mean_t = sum(f[0] for f in late) / len(late)
ours, theirs = (sum((f[0] - mean_t) * f[k] for f in late) / sum((f[0] - mean_t) ** 2 for f in late) for k in (1, 2))
rows.relative("speed of the front (z > 0.05 m), 0.28 to 0.59 s", "m/s", ours, theirs, 0.05)
