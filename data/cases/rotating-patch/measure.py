#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a freely rotating patch must keep: angular momentum, energy, an even distribution of particles."""
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools

run = tools.run_argument()
rows = tools.Rows()
dp = tools.scene(run)["resolution"]["dp"]
frames = tools.frames(run)


def spin(frame):
    return sum(r[2] * v[0] - r[0] * v[2] for v, r in zip(frame["velocity"], frame["position"]))


def energy(frame):
    return sum(v[0] ** 2 + v[2] ** 2 for v in frame["velocity"])


def clumped(frame):
    """Share of particles that have another within dp/2."""
    cells = {}
    for k, r in enumerate(frame["position"]):
        cells.setdefault((math.floor(r[0] / dp), math.floor(r[2] / dp)), []).append(k)
    count = 0
    for k, r in enumerate(frame["position"]):
        i, j = math.floor(r[0] / dp), math.floor(r[2] / dp)
        near = [m for a in (-1, 0, 1) for b in (-1, 0, 1) for m in cells.get((i + a, j + b), []) if m != k]
        count += any(math.dist(r, frame["position"][m]) < 0.5 * dp for m in near)
    return count / len(frame["position"])


first, last = tools.read_vtp(frames[0][1]), tools.read_vtp(frames[-1][1])
rows.relative("angular momentum at 2 s over that at the start", "1", spin(last) / spin(first), 1.0, 0.01)
most = max(energy(tools.read_vtp(path)) for _, path in frames) / energy(first)
rows.add("largest kinetic energy over that at the start", "1", most, 1.0, max(0.0, most - 1.0), 0.001)
rows.add("kinetic energy lost at 2 s", "1", 1.0 - energy(last) / energy(first), 0.0, 1.0 - energy(last) / energy(first), 0.2)
share = clumped(last)
rows.add("share of particles with another within dp/2 at 2 s", "1", share, 0.0, share, 0.01)
lost = tools.last_log(run)["lost_fluid"]
rows.add("particles lost", "1", lost, 0, lost, 0)
