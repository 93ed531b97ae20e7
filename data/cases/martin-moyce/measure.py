#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Front and residual height of the column of Martin & Moyce 1952."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools

WIDTH, HEIGHT, GRAVITY = 0.05715, 0.1143, 9.81
RATE = (GRAVITY / WIDTH) ** 0.5  # 1/s

run = tools.run_argument()
rows = tools.Rows()
measured = [row for row in tools.reference("martin_moyce_1952") if row["n2"] == 2]


def differences(series, times, values, shift, start, end):
    """Computed over measured, less one, at the measured times."""
    return [tools.at(row["T"] + shift, times, values) / row["value"] - 1.0
            for row in measured if row["series"] == series and start <= row["T"] and row["T"] + shift <= end]


front = tools.analyze("front", run)
times, values = [2 ** 0.5 * RATE * row["t"] for row in front], [row["x_front"] / WIDTH for row in front]
shift, value = tools.best_shift(lambda s: tools.root_mean_square(differences("front", times, values, s, 1.0, times[-1])), 0.3, 0.01)
rows.add(f"front Z from T = 1 on, RMS of the relative error (best shift, within 0.3)", "1", value, 0.0, value, 0.05)
rows.add("shift of T", "1", shift, 0.0, shift, 0.3)
slope = (tools.at(3.0, times, values) - tools.at(1.5, times, values)) / 1.5
fitted = sorted((row["T"], row["value"]) for row in measured if row["series"] == "front")
known = (tools.at(3.0, *zip(*fitted)) - tools.at(1.5, *zip(*fitted))) / 1.5
rows.relative("front speed dZ/dT, T = 1.5 to 3", "1", slope, known, 0.05)

tools.picture(run, "front", "T = t sqrt(2 g / a)", "Z = x / a", {"": list(zip(times, values))},
              {"Martin and Moyce 1952, n2 = 2": [(row["T"] + shift, row["value"]) for row in measured if row["series"] == "front"]}, key="top left")

levels = tools.analyze("profile", run, "--line", "0.004,0,0.012,0", "--step", "0.004")
by_time = {}
for row in levels:
    by_time.setdefault(row["t"], []).append(row["z_surface"])
heights = [(t * RATE, sum(z) / len(z) / HEIGHT) for t, z in sorted(by_time.items())]
errors = differences("height", [t for t, _ in heights], [z for _, z in heights], 0.0, 0.0, heights[-1][0])
value = tools.root_mean_square(errors)
rows.add("height at the wall, RMS of the relative error (no shift)", "1", value, 0.0, value, 0.05)
