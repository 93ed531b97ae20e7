#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Settling speed inside a cloud of grains against Richardson & Zaki, and what the drag law itself says."""
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools

run = tools.run_argument()
rows = tools.Rows()
scene = tools.scene(run)
slide, law = scene["slide"][0], scene["coupling"]["drag"]
d, rho_s, rho, nu, g = slide["real_diameter"], slide["density"], scene["fluid"]["density"], scene["fluid"]["kinematic_viscosity"], 9.81


def drag_of_law(w, eps):
    """Force on a grain over its volume, N/m3; w: interstitial slip (m/s)."""
    superficial = eps * w
    reynolds = superficial * d / nu
    if law == "di-felice":
        c = (0.63 + 4.8 / math.sqrt(reynolds)) ** 2
        xi = 3.7 - 0.65 * math.exp(-0.5 * (1.5 - math.log10(reynolds)) ** 2)
        return 0.75 * c * rho * superficial ** 2 * eps ** -xi / d
    if eps <= 0.8:
        return (150.0 * (1.0 - eps) * nu * rho / (eps * d * d) + 1.75 * rho * w / d) * w
    c = 24.0 / reynolds * (1.0 + 0.15 * reynolds ** 0.687) if reynolds < 1000.0 else 0.44
    return 0.75 * c * eps ** -1.65 * rho * w * w / d


def settling(eps):
    """Speed against the walls: interstitial slip times eps, drag over the volume carries (rho_s - rho_mixture) g."""
    low, high = 1e-9, 5.0
    for _ in range(100):
        w = 0.5 * (low + high)
        low, high = (w, high) if drag_of_law(w, eps) < eps * (rho_s - rho) * g else (low, w)
    return low * eps


def mean_porosity(frame, low, high):
    volume = sum(math.pi / 6.0 * x ** 3 for x, r in zip(frame["diameter"], frame["position"]) if low <= r[2] < high)
    return 1.0 - volume / (0.024 ** 2 * (high - low))


# The middle of the cloud keeps its porosity until the rarefaction or the bed reaches it.
speeds, porosities = [], []
for t, path in tools.frames(run, "grains"):
    if 0.12 <= t <= 0.3:
        frame = tools.read_vtp(path)
        offset = settling(slide["porosity"]) * t
        low, high = 0.05 - 0.5 * offset, 0.08 - 0.5 * offset
        inside = [v[2] for v, r in zip(frame["velocity"], frame["position"]) if low <= r[2] < high]
        speeds.append(-sum(inside) / len(inside))
        porosities.append(mean_porosity(frame, low, high))
u, eps = sum(speeds) / len(speeds), sum(porosities) / len(porosities)
u_t = settling(1.0)
reynolds = u_t * d / nu
n = 4.65 if reynolds < 0.2 else 4.35 * reynolds ** -0.03 if reynolds < 1.0 else 4.45 * reynolds ** -0.1 if reynolds < 500.0 else 2.39
rows.relative("settling speed / that of the drag law", "m/s", u, settling(eps), 0.03)
rows.relative("settling speed / Richardson-Zaki", "m/s", u, u_t * eps ** n, 0.03)
rows.add("porosity in the middle", "1", eps, slide["porosity"], eps - slide["porosity"], 0.03)
