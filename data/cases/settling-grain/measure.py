#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Terminal velocity of one bead against the drag coefficient that its law is made of, in unbounded water."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools

run = tools.run_argument()
rows = tools.Rows()
scene = tools.scene(run)
law = scene["coupling"]["drag"]
diameter, grain_density, density = scene["slide"][0]["diameter"], scene["slide"][0]["density"], scene["fluid"]["density"]
viscosity = scene["fluid"]["kinematic_viscosity"]


def coefficient(reynolds):
    if law == "di-felice":
        return (0.63 + 4.8 / reynolds ** 0.5) ** 2
    return 24.0 / reynolds * (1.0 + 0.15 * reynolds ** 0.687) if reynolds < 1000.0 else 0.44


low, high = 0.0, 10.0
for _ in range(100):
    u = 0.5 * (low + high)
    drag = 0.125 * 3.14159265 * diameter ** 2 * coefficient(u * diameter / viscosity) * density * u * u
    weight = 3.14159265 / 6.0 * diameter ** 3 * (grain_density - density) * 9.81
    low, high = (u, high) if drag < weight else (low, u)
speeds = [-tools.read_vtp(path)["velocity"][0][2] for t, path in tools.frames(run, "grains") if 0.2 <= t <= 0.4]
rows.relative(f"terminal velocity, {law}", "m/s", sum(speeds) / len(speeds), low, 0.03)
