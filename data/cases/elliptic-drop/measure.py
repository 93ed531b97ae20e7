#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Semi-axes of the drop, by its second moments, against the exact ones; what is kept of its kinetic energy.

A homogeneous ellipse has mean x^2 = a^2/4. Exact: da/dt = -A a, a b = 1 m2, dA/dt = A^2 (a^2 - b^2)/(a^2 + b^2); kinetic energy
pi rho A^2 a b (a^2 + b^2)/8.
"""
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools


def exact(end, steps=20000):
    """a, b (m) and A (1/s) at the time `end`, by the midpoint rule."""
    rate = lambda a, A: (-A * a, A * A * (a * a - 1.0 / (a * a)) / (a * a + 1.0 / (a * a)))
    a, A, dt = 1.0, 100.0, end / steps
    for _ in range(steps):
        da, dA = rate(a, A)
        da, dA = rate(a + 0.5 * dt * da, A + 0.5 * dt * dA)
        a, A = a + dt * da, A + dt * dA
    return a, 1.0 / a, A


def semi_axis(frame, axis):
    return 2.0 * math.sqrt(sum(r[axis] ** 2 for r in frame["position"]) / len(frame["position"]))


run = tools.run_argument()
rows = tools.Rows()
frames = tools.frames(run)
curves = {"long": [], "short": []}
for time, path in frames:
    frame = tools.read_vtp(path)
    curves["long"].append((1e3 * time, semi_axis(frame, 2)))
    curves["short"].append((1e3 * time, semi_axis(frame, 0)))
end, last = frames[-1][0], tools.read_vtp(frames[-1][1])
a, b, A = exact(end)
rows.relative("long semi-axis at 7.6 ms", "m", semi_axis(last, 2), b, 0.01)
rows.relative("short semi-axis at 7.6 ms", "m", semi_axis(last, 0), a, 0.02)
speed2 = sum(v[0] ** 2 + v[2] ** 2 for v in last["velocity"]) / len(last["velocity"])
rows.relative("kinetic energy at 7.6 ms", "m2/s2", 0.5 * speed2, A * A * (a * a + b * b) / 8.0, 0.02)
lost = tools.last_log(run)["lost_fluid"]
rows.add("particles lost", "1", lost, 0, lost, 0)
times = [1e-3 * t for t, _ in curves["long"]]
tools.picture(run, "axes", "t (ms)", "semi-axis (m)", curves,
              {"exact, long": [(1e3 * t, exact(t, 2000)[1]) for t in times], "exact, short": [(1e3 * t, exact(t, 2000)[0]) for t in times]},
              measured=False, key="top left")
