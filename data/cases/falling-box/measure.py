#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The wave that a falling box makes: its speed for its height, the height it keeps, and where the box ends."""
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools

run = tools.run_argument()
rows = tools.Rows()
scene = tools.scene(run)
depth = scene["fluid"]["fill"][0]["box"]["upper"][2]
place = {gauge["name"]: gauge["at"][0] for gauge in scene["gauge"]}
table = tools.analyze("gauge", run)


def crest(name):
    """(time, height) of the largest rise, by a parabola through the three highest neighbours."""
    curve = [(row["t"], row["rise"]) for row in table if row["gauge"] == name]
    k = max(range(1, len(curve) - 1), key=lambda i: curve[i][1])
    (t0, a), (t1, b), (t2, c) = curve[k - 1:k + 2]
    bend = a - 2.0 * b + c
    shift = 0.5 * (a - c) / bend if bend < 0.0 else 0.0
    return t1 + shift * (t2 - t1), b - 0.25 * (a - c) * shift


(t_middle, a_middle), (t_far, a_far) = crest("middle"), crest("far")
height = 0.5 * (a_middle + a_far)
speed = (place["far"] - place["middle"]) / (t_far - t_middle)
rows.relative("speed of the wave / sqrt(g (D + a))", "1", speed / math.sqrt(9.81 * (depth + height)), 1.0, 0.05)
rows.relative("height of the wave, far / middle gauge", "1", a_far / a_middle, 1.0, 0.1)
states = [tools.read_vtp(path) for _, path in tools.frames(run, "bodies")]
box = scene["floating"][0]["box"]
bottom = states[-1]["body_centre"][2] - 0.5 * (box["upper"][2] - box["lower"][2])
rows.add("bottom of the box at the end / D", "1", bottom / depth, 0.0, bottom / depth, 0.1)
print(f"height of the wave: {a_middle:.4f} m at x = {place['middle']} m, {a_far:.4f} m at x = {place['far']} m", file=sys.stderr)
