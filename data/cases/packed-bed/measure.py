#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Superficial velocity of steady flow through held grains, and the pressure drop that the run's drag law gives for it."""
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools

run = tools.run_argument()
rows = tools.Rows()
scene = tools.scene(run)
rho, nu, d = scene["fluid"]["density"], scene["fluid"]["kinematic_viscosity"], scene["slide"][0]["diameter"]
driving = rho * scene["gravity"][0]
grains = tools.read_vtp(tools.frames(run, "grains")[-1][1])
solid = sum(math.pi / 6.0 * x ** 3 for x in grains["diameter"])
eps = 1.0 - solid / (0.048 * 0.024 * 0.048)
last = [tools.read_vtp(path)["velocity"] for _, path in tools.frames(run)[-5:]]
means = [sum(v[0] for v in frame) / len(frame) for frame in last]
U = eps * sum(means) / len(means)
ergun = 150.0 * nu * rho * (1.0 - eps) ** 2 * U / (eps ** 3 * d * d) + 1.75 * rho * (1.0 - eps) * U * U / (eps ** 3 * d)


def di_felice(U):
    """Pa/m: drag a volume of bed, over eps (the pressure gradient carries the rest of the force on the grains)."""
    reynolds = rho * U * d / (rho * nu)
    drag = (0.63 + 4.8 / math.sqrt(reynolds)) ** 2
    xi = 3.7 - 0.65 * math.exp(-0.5 * (1.5 - math.log10(reynolds)) ** 2)
    return 0.75 * (1.0 - eps) * drag * rho * U * U * eps ** -xi / d / eps


law = scene["coupling"]["drag"]
if law == "di-felice":
    rows.relative(f"pressure drop at U = {U:.4g} m/s, Di Felice over driven (di-felice)", "Pa/m", di_felice(U), driving, 0.05)
    rows.stated(f"pressure drop at U = {U:.4g} m/s, Ergun over driven (di-felice)", "Pa/m", ergun, f"{driving:g}, another correlation")
else:
    rows.relative(f"pressure drop at U = {U:.4g} m/s, Ergun over driven ({law})", "Pa/m", ergun, driving, 0.05)
rows.add("change of U over the last frames", "1", means[-1] / means[0] - 1.0, 0.0, means[-1] / means[0] - 1.0, 0.02)
