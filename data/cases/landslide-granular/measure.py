#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Highest climb at the wall opposite the slope, particles lost. (Energy: the budget that scripts/validate draws up of every run.)"""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools

run = tools.run_argument()
rows = tools.Rows()
wall = [row for row in tools.analyze("runup", run) if row["region"] == "wall"]
rows.stated("highest climb of connected water at the wall", "m", max(row["run_up"] for row in wall), "stated as a ratio only")
rows.stated("highest splash at the wall", "m", max(row["splash"] for row in wall), "none")
last = tools.last_log(run)
lost = last["lost_fluid"] + last["lost_grains"]
rows.add("particles lost", "1", lost, 0.0, lost, 0.0)
