#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Period and damping of the standing wave, from the velocity projected on the linear mode."""
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools

K, DEPTH, GRAVITY = 2.0 * math.pi, 0.5, 9.81
OMEGA = math.sqrt(GRAVITY * K * math.tanh(K * DEPTH))


def mode(r):
    return math.cosh(K * r[2]) * math.sin(K * r[0]), -math.sinh(K * r[2]) * math.cos(K * r[0])


run = tools.run_argument()
rows = tools.Rows()
history = []
for time, path in tools.frames(run):
    frame = tools.read_vtp(path)
    share = norm = 0.0
    for v, r in zip(frame["velocity"], frame["position"]):
        u, w = mode(r)
        share += v[0] * u + v[2] * w
        norm += u * u + w * w
    history.append((time, share / norm))
history = [(t, a / history[0][1]) for t, a in history]
tools.picture(run, "amplitude", "t [s]", "velocity of the mode over that at the start", {"": history},
              {"linear theory, no viscosity": [(0.02 * k, math.cos(OMEGA * 0.02 * k)) for k in range(int(50 * history[-1][0]) + 1)]}, measured=False)
zeros = [t0 + (t1 - t0) * a0 / (a0 - a1) for (t0, a0), (t1, a1) in zip(history, history[1:]) if a0 * a1 < 0.0]
period = 2.0 * (zeros[-1] - zeros[0]) / (len(zeros) - 1)
rows.relative("period", "s", period, 2.0 * math.pi / OMEGA, 0.01)
# Amplitude: a^2 + (a'/omega)^2 does not oscillate; here by least squares over the last and first whole period.
def amplitude(start):
    part = [(t, a) for t, a in history if start - 1e-9 <= t < start + period - 1e-9]
    return math.sqrt(2.0 * sum(a * a for _, a in part) / len(part))


last = history[-1][0] - period
decay = math.log(amplitude(0.0) / amplitude(last)) / last
rows.add("amplitude lost in a period", "1", 1.0 - math.exp(-decay * period), 0.0, 1.0 - math.exp(-decay * period), 0.05)
