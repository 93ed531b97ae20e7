#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Final heap of the soil collapse: run-out, and height that is left at the wall."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools

LENGTH, RELEASE = 0.20, 0.3
run = tools.run_argument()
rows = tools.Rows()
base = 1.5 * tools.scene(run)["resolution"]["dp"]


def heap(time):
    """The rods that move, above the base."""
    frame = tools.frame_near(run, time, "grains")[1]
    free = [k for k, group in enumerate(frame["group"]) if group == 0]
    return {"position": [(x, y, z - base) for x, y, z in (frame["position"][k] for k in free)],
            "diameter": [frame["diameter"][k] for k in free]}


start, end = heap(RELEASE), heap(1e9)
top = sorted(r[2] + 0.5 * d for r, d in zip(start["position"], start["diameter"]))
height = top[int(0.99 * len(top))]
a = height / LENGTH
front = tools.connected_front(end, depth=1.5 * max(end["diameter"]))
rows.relative(f"run-out (L - L0)/L0 at a = {a:.3f}, against 1.2 a of rough grains", "1", front / LENGTH - 1.0, 1.2 * a, 0.20)
back = max(r[2] + 0.5 * d for r, d in zip(end["position"], end["diameter"]) if r[0] < 0.1 * LENGTH)
rows.relative("height left at the wall / height before", "1", back, height, 0.05)
overlap = tools.last_log(run)["largest_overlap"]
rows.add("largest overlap / diameter at the end", "1", overlap, 0.0, overlap, 0.01)
