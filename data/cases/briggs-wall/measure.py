#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Crest at two gauges, travel time between them, run-up on the wall, against Briggs et al. 1996, case C."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools

run = tools.run_argument()
rows = tools.Rows()
toe, shelf, climb = tools.reference("briggs_1996_composite_beach")
table = tools.analyze("gauge", run)


def crest(name):
    return max((row["rise"], -row["t"]) for row in table if row["gauge"] == name)


(at_toe, t_toe), (at_shelf, t_shelf) = crest("toe"), crest("shelf")
rows.relative("crest at the toe, x = 15.04 m", "m", at_toe, toe["value"], 0.05)
rows.relative("crest where the shelf begins, x = 19.40 m", "m", at_shelf, shelf["value"], 0.1)
rows.relative("time from the one to the other", "s", t_toe - t_shelf, shelf["t"] - toe["t"], 0.05)
wall = [row for row in tools.analyze("runup", run) if row["region"] == "wall"]
rows.relative("run-up on the wall", "m", max(row["run_up"] for row in wall), climb["value"], 0.1)
