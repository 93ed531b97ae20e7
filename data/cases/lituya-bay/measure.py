#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Run-up on the headland against nature's trimline; the wave at the gauge 885 m from the shore of the slide is written down beside the model's.

Height: from the crest to the lowest level of the 10 s that follow it.
"""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
import measure_tools as tools

run = tools.run_argument()
rows = tools.Rows()
known = {row["quantity"]: row["value"] for row in tools.reference("fritz_2001_lituya_bay")}
quoted = lambda name: f"{known[name]:g} (model, as quoted)"
gauge = [(row["t"], row["rise"]) for row in tools.analyze("gauge", run)]
crest = max(rise for _, rise in gauge)
peak = next(time for time, rise in gauge if rise == crest)
trough = min(rise for time, rise in gauge if peak <= time <= peak + 10.0)
climb = [(row["t"], row["run_up"]) for row in tools.analyze("runup", run) if row["region"] == "headland"]
rows.relative("run-up on the headland", "m", max(height for _, height in climb), known["run-up in nature"], 0.1)
rows.stated("crest at the gauge, above still water", "m", crest, quoted("crest at the gauge"))
rows.stated("height of the first wave at the gauge", "m", crest - trough, quoted("height of the wave at the gauge"))
end = gauge[-1][0]
tools.picture(run, "gauge", "t (s)", "rise at the gauge (m)", {"water": gauge},
              {"crest of the model, as quoted": [(0.0, known["crest at the gauge"]), (end, known["crest at the gauge"])]}, measured=False,
              key="center right")
tools.picture(run, "run-up", "t (s)", "run-up on the headland (m)", {"water": climb},
              {"nature": [(0.0, known["run-up in nature"]), (end, known["run-up in nature"])]}, measured=False, key="bottom right")
