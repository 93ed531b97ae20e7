# SPDX-License-Identifier: GPL-3.0-or-later
"""What the measure.py of the validation cases share: a run's tables and frames, reference curves, rows of the table.

A measure.py is called with a run folder, finds surge-analyze on the PATH and prints, tab-separated, a header and
one row a metric: metric, unit, value, reference, error, band (scripts/validate --help). For standard Python alone.
"""
import bisect
import csv
import json
import math
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import vtp

REFERENCE = Path(__file__).resolve().parent.parent / "data" / "reference"


class Rows:
    """Collects rows and prints the table."""

    def __init__(self):
        print("metric\tunit\tvalue\treference\terror\tband", flush=True)

    def add(self, metric, unit, value, reference, error, band):
        """`error` in the metric's own terms; accepted when |error| <= band."""
        print("\t".join([metric, unit, f"{value:.5g}", f"{reference:.5g}" if not isinstance(reference, str) else reference,
                         f"{error:.4g}", f"{band:g}"]), flush=True)

    def stated(self, metric, unit, value, reference):
        """A number that no reference has, written down without being judged."""
        self.add(metric, unit, value, reference, math.nan, math.nan)

    def relative(self, metric, unit, value, reference, band):
        self.add(metric, unit, value, reference, value / reference - 1.0, band)


def picture(run, name, x, y, curves, reference, measured=True, key="top right"):
    """Keeps curves for a picture of docs/validation.md (validation_pictures.py): RUN/curves/NAME.json.

    `curves`, `reference`: label -> [(x, y), ...], the run's and what it is compared with; `x`, `y`: titles of the axes with
    units; `measured`: drawn as points, else as a line; `key`: where gnuplot puts the legend."""
    folder = Path(run) / "curves"
    folder.mkdir(exist_ok=True)
    (folder / f"{name}.json").write_text(json.dumps(
        {"x": x, "y": y, "run": curves, "reference": reference, "measured": measured, "key": key}))


def analyze(command, run, *options):
    """Rows of a surge-analyze table: numbers under the names of the columns without their units."""
    text = subprocess.run(["surge-analyze", command, str(run), "--quiet", *options], stdout=subprocess.PIPE, check=True,
                          text=True).stdout
    lines = [line.split("\t") for line in text.splitlines()]
    names = [name.split("[")[0] for name in lines[0]]
    return [dict(zip(names, map(as_number, line))) for line in lines[1:]]


def as_number(text):
    try:
        return float(text)
    except ValueError:
        return text


def reference(name):
    """Rows of data/reference/NAME.csv."""
    with open(REFERENCE / f"{name}.csv", newline="") as file:
        rows = csv.DictReader(line for line in file if not line.startswith("#"))
        return [{re.sub(r"\[.*\]", "", key): as_number(value) for key, value in row.items()} for row in rows]


def at(x, xs, ys):
    """Linear between the points, constant beyond."""
    k = bisect.bisect_right(xs, x)
    if k == 0:
        return ys[0]
    if k == len(xs):
        return ys[-1]
    return ys[k - 1] + (ys[k] - ys[k - 1]) * (x - xs[k - 1]) / (xs[k] - xs[k - 1])


def scene(run):
    """The scene of a run, every default filled in."""
    folder = Path(json.loads((Path(run) / "run.json").read_text())["case"])
    with open(folder / "case.toml", "rb") as file:
        return tomllib.load(file)


def last_log(run):
    """The last line of the run's diagnostics."""
    lines = (Path(run) / "log.ndjson").read_text().strip().splitlines()
    return next(record for record in map(json.loads, reversed(lines)) if "largest_speed" in record)


def read_vtp(path):
    """The arrays of a frame: name -> numbers, or triples for position and velocity."""
    arrays = vtp.read_arrays(path)
    arrays["position"] = arrays["Points"]
    return {name: vtp.vectors(values) if name in ("position", "velocity") else values for name, values in arrays.items()}


def frames(run, kind="fluid"):
    """(time in s, path) of each frame, in order of time."""
    series = (Path(run) / f"{kind}.pvd").read_text()
    found = []
    for head in re.findall(r"<DataSet ([^>]*)/>", series):
        given = dict(re.findall(r'(\w+)="([^"]*)"', head))
        found.append((float(given["timestep"]), Path(run) / given["file"]))
    return sorted(found)


def frame_near(run, time, kind="fluid"):
    """(time, arrays) of the frame nearest to a time."""
    t, path = min(frames(run, kind), key=lambda frame: abs(frame[0] - time))
    return t, read_vtp(path)


def crest(curve, share=0.8):
    """(time, height) of a wave's crest in [(t, height), ...]: the parabola fitted by least squares to what is above `share` of the highest
    point, without a gap around it. The highest reading alone is the crest with the noise of the surface on top."""
    top = max(range(len(curve)), key=lambda k: curve[k][1])
    low = high = top
    while low > 0 and curve[low - 1][1] >= share * curve[top][1]:
        low -= 1
    while high + 1 < len(curve) and curve[high + 1][1] >= share * curve[top][1]:
        high += 1
    points = curve[low:high + 1]
    if len(points) < 3:
        return curve[top]
    mean = sum(t for t, _ in points) / len(points)
    power = [sum((t - mean) ** p for t, _ in points) for p in range(5)]
    moment = [sum((t - mean) ** p * z for t, z in points) for p in range(3)]
    # Normal equations of a + b x + c x^2, by Cramer's rule.
    matrix = [[power[i + j] for j in range(3)] for i in range(3)]
    a, b, c = (determinant([[moment[i] if j == k else matrix[i][j] for j in range(3)] for i in range(3)]) / determinant(matrix) for k in range(3))
    if c >= 0.0:
        return curve[top]
    return mean - 0.5 * b / c, a - 0.25 * b * b / c


def determinant(m):
    """Of three rows of three."""
    return sum(m[0][k] * (m[1][(k + 1) % 3] * m[2][(k + 2) % 3] - m[1][(k + 2) % 3] * m[2][(k + 1) % 3]) for k in range(3))


def connected_front(grains, direction=0, gap=0.25, depth=0.0):
    """Outer edge (m) along an axis of the largest heap of grains that touch, or nearly: `gap` of a diameter apart at most.

    With a `depth` (m above z = 0) the outermost of them whose top is that high: a lone grain in front is no deposit.
    """
    places, sizes = grains["position"], grains["diameter"]
    width = (1.0 + gap) * max(sizes)
    cells = {}
    for k, r in enumerate(places):
        cells.setdefault(tuple(math.floor(c / width) for c in r), []).append(k)
    heap_of, largest = {}, []
    for seed in range(len(places)):
        if seed in heap_of:
            continue
        heap, heap_of[seed] = [seed], seed
        for k in heap:  # grows while it is walked
            home = tuple(math.floor(c / width) for c in places[k])
            for cell in ((home[0] + i, home[1] + j, home[2] + m) for i in (-1, 0, 1) for j in (-1, 0, 1) for m in (-1, 0, 1)):
                for other in cells.get(cell, ()):
                    reach = (0.5 + 0.5 * gap) * (sizes[k] + sizes[other])
                    if other not in heap_of and math.dist(places[k], places[other]) < reach:
                        heap_of[other] = seed
                        heap.append(other)
        largest = max(largest, heap, key=len)
    return max(places[k][direction] + 0.5 * sizes[k] for k in largest if places[k][2] + 0.5 * sizes[k] >= depth)


def root_mean_square(values):
    values = list(values)
    return math.sqrt(sum(v * v for v in values) / len(values)) if values else math.nan


def best_shift(error, limit, step):
    """(shift, error there): of the shifts -limit, -limit + step, ... limit the one with the smallest error(shift), the smaller in size of equal ones."""
    steps = round(limit / step)
    return min(((k * step, error(k * step)) for k in sorted(range(-steps, steps + 1), key=abs)), key=lambda pair: pair[1])


def run_argument():
    if len(sys.argv) != 2:
        sys.exit("usage: measure.py RUN_FOLDER")
    return Path(sys.argv[1])
