#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Dam break of Lobovsky et al. 2014: arrival at the far wall, pressure at its sensors.

Pressure is passed through a running median 0.1 t* wide, which takes the sound of a weakly compressible impact out. A peak
counts as accepted inside the 2.5-97.5 % band of 100 repeats; its error is the share by which it lies outside.
"""
import statistics
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools

HEIGHT, GRAVITY, DENSITY, WALL = 0.3, 9.81, 997.0, 1.61
RATE = (GRAVITY / HEIGHT) ** 0.5
SCALE = DENSITY * GRAVITY * HEIGHT
HEIGHTS = {"sensor2": 15.0, "sensor3": 30.0}  # mm

run = tools.run_argument()
rows = tools.Rows()
dp = tools.scene(run)["resolution"]["dp"]

front = [(row["t"] * RATE, row["x_tip"]) for row in tools.analyze("front", run)]
arrival = float("nan")
for (t0, x0), (t1, x1) in zip(front, front[1:]):
    if x1 >= WALL - 0.5 * dp > x0:
        arrival = t0 + (t1 - t0) * (WALL - 0.5 * dp - x0) / (x1 - x0)
        break
rows.relative("arrival at the wall, t*", "1", arrival, 2.42, 0.05)


def pressures(sensor):
    curve = [(row["t"] * RATE, row["pressure"] / SCALE) for row in gauges if row["gauge"] == sensor]
    return [(t, statistics.median(p for s, p in curve if abs(s - t) <= 0.05)) for t, _ in curve]


def outside(value, low, high):
    return (value - high) / high if value > high else min(0.0, (value - low) / low)


gauges = tools.analyze("gauge", run)
peaks = {row["z"]: row for row in tools.reference("lobovsky_2014_h300_peaks")}
for sensor, z in HEIGHTS.items():
    peak = max(p for t, p in pressures(sensor) if t < 3.2)
    known = peaks[z]
    band = f"{known['p_star_median']:g} ({known['p_star_low']:g} to {known['p_star_high']:g})"
    rows.add(f"first peak, {sensor}, p / (rho g H)", "1", peak, band, outside(peak, known["p_star_low"], known["p_star_high"]), 0.0)

measured = tools.reference("lobovsky_2014_h300_pressure")
curve = pressures("sensor2")
tools.picture(run, "sensor2", "t sqrt(g / H)", "pressure at sensor 2 / (rho g H)", {"": curve},
              {f"Lobovsky et al. 2014, {what}": [(row["t_star"], row[f"p_{key}"]) for row in measured if row["t_star"] < 5.0]
               for what, key in (("median", "median"), ("2.5 %", "low"), ("97.5 %", "high"))})
times, values = [t for t, _ in curve], [p for _, p in curve]
compared = [row for row in measured if 2.8 <= row["t_star"] <= min(4.0, times[-1])]
if compared:
    difference = [tools.at(row["t_star"], times, values) - row["p_median"] for row in compared]
    value = tools.root_mean_square(difference)
    rows.add("sensor 2 after the peak (t* 2.8 to 4), RMS / (rho g H)", "1", value, 0.0, value, 0.1)
