#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Decay rate and velocity field of Taylor-Green vortices."""
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools

REYNOLDS, K = 100.0, 2.0 * math.pi
RATE = 2.0 * K * K / REYNOLDS  # 1/s, of the velocity


def field(r):
    return math.sin(K * r[0]) * math.cos(K * r[2]), -math.cos(K * r[0]) * math.sin(K * r[2])


run = tools.run_argument()
rows = tools.Rows()
logs = []
for time, path in tools.frames(run):
    frame = tools.read_vtp(path)
    energy = sum(v[0] ** 2 + v[2] ** 2 for v in frame["velocity"]) / len(frame["velocity"])
    logs.append((time, 0.5 * math.log(energy)))
chosen = [(t, l) for t, l in logs if 0.2 <= t <= 1.0]
mean_t, mean_l = (sum(c[k] for c in chosen) / len(chosen) for k in (0, 1))
slope = sum((t - mean_t) * (l - mean_l) for t, l in chosen) / sum((t - mean_t) ** 2 for t, _ in chosen)
rows.relative("decay rate of the velocity, 0.2 to 1 s", "1/s", -slope, RATE, 0.02)
tools.picture(run, "decay", "t [s]", "root mean square velocity over that at the start", {"": [(t, math.exp(l - logs[0][1])) for t, l in logs]},
              {"exact": [(0.02 * k, math.exp(-RATE * 0.02 * k)) for k in range(51)]}, measured=False)
scale = math.exp(-RATE * time)
errors = []
for v, r in zip(frame["velocity"], frame["position"]):
    u, w = field(r)
    errors.append(math.hypot(v[0] - scale * u, v[2] - scale * w) / scale)
value = tools.root_mean_square(errors)
rows.add("velocity field at 1 s, RMS error / highest speed", "1", value, 0.0, value, 0.02)
