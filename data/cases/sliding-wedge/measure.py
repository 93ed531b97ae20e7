#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A wedge that slides down a slope under water: its first acceleration, where it ends, and the budget of energy."""
import json
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools

GRAVITY, SINE = 9.81, 0.5 ** 0.5
run = tools.run_argument()
rows = tools.Rows()
scene = tools.scene(run)
dp, ratio = scene["resolution"]["dp"], scene["slide"][0]["density"] / scene["fluid"]["density"]

states = [(t, tools.read_vtp(path)["body_centre"][0]) for t, path in tools.frames(run, "bodies")]
start = states[0][1]
path = [(t, ((x - start[0]) ** 2 + (z - start[2]) ** 2) ** 0.5) for t, (x, _, z) in states]
t, s = next((t, s) for t, s in path if s >= 0.05)
added = ((ratio - 1.0) * GRAVITY * SINE * t * t / (2.0 * s)) - ratio   # of s = a t^2 / 2
rows.add("added mass over the first 0.05 m / displaced water", "1", added, 1.0, added - 1.0, 0.5)

drop = start[2] - states[-1][1][2]
rows.add("drop of the centre until the end", "m", drop, 0.49, drop - 0.49, 2.0 * dp)   # from the slope to the foot

log = [json.loads(line) for line in (run / "log.ndjson").read_text().splitlines()]
names = [f"{part}_{kind}" for part in ("fluid", "body") for kind in ("kinetic", "potential", "elastic")]
energy = [sum(line[name] for name in names) for line in log]
released = log[0]["body_potential"] - log[-1]["body_potential"]
gain = max((e - energy[0]) / released for e in energy)
rows.add("energy created / energy that the block gave", "1", gain, 0.0, max(gain, 0.0), 0.02)
