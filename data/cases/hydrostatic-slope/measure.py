#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Still water over a slope: judged as the tank of hydrostatic, whose depth it has."""
import runpy
from pathlib import Path

runpy.run_path(str(Path(__file__).resolve().parent.parent / "hydrostatic" / "measure.py"))
