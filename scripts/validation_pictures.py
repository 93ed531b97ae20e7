# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of the validation page: curves of the runs beside the reference's, drawn by gnuplot.

A measure.py hands over its curves with measure_tools.picture(); they are kept in RUN_FOLDER/curves/NAME.json. The
finest run of each preset and variant goes into docs/validation/CASE.NAME.svg."""
import json
import re
import shutil
import subprocess
from pathlib import Path

STYLES = {"accurate": "lines lc rgb '#1f5fbf' lw 2", "paper": "lines lc rgb '#c05020' lw 1"}
MOST_POINTS = 160


def thinned(points):
    step = max(1, -(-len(points) // MOST_POINTS))
    return points[::step]


def quoted(text):
    return "'" + str(text).replace("'", "''") + "'"


def block(name, points):
    return f"${name} << EOD\n" + "".join(f"{x:.5g} {y:.5g}\n" for x, y in thinned(points)) + "EOD\n"


def draw(path, title, runs):
    """`runs`: (label, style, picture) with the picture as measure_tools.picture() kept it; the reference is the first one's."""
    first = runs[0][2]
    data, plots = "", []
    for k, (label, points) in enumerate(first["reference"].items()):
        data += block(f"r{k}", points)
        form = "points pt 6 ps 0.5" if first["measured"] else "lines dt 2 lw 1.5"
        plots.append(f"$r{k} with {form} lc rgb '#303030' title {quoted(label)}")
    for k, (label, style, picture) in enumerate(runs):
        for n, (name, points) in enumerate(picture["run"].items()):
            data += block(f"c{k}_{n}", points)
            plots.append(f"$c{k}_{n} with {style} title {quoted(label + (' ' + name if name else ''))}" if n == 0 else f"$c{k}_{n} with {style} notitle")
    script = (f"set terminal svg size 640,380 font 'Helvetica,11' background 'white'\nset output {quoted(path)}\nset title {quoted(title)} noenhanced\n"
              f"set xlabel {quoted(first['x'])} noenhanced\nset ylabel {quoted(first['y'])} noenhanced\nset key noenhanced {first['key']}\nset grid lc rgb '#dddddd'\n"
              + data + "plot " + ", ".join(plots) + "\n")
    subprocess.run(["gnuplot"], input=script, text=True, check=True)
    # No creation date or program version in the file: the same curves give the same bytes.
    path.write_text(re.sub(r"<!--.*?-->|<desc>.*?</desc>", "", path.read_text(), flags=re.S))


def draw_case(case, runs, folder):
    """The pictures of a case into `folder`; `runs`: (preset, variant, dp, run folder) of those that ended. Returns their names."""
    if shutil.which("gnuplot") is None:
        return []
    found = {}
    variants = sorted({variant for _, variant, _, _ in runs})
    for preset, variant, dp, run in sorted(runs, key=lambda r: r[:3]):
        for file in sorted((Path(run) / "curves").glob("*.json")):
            kept = found.setdefault(file.stem, {})
            spacing = f"{1000.0 * dp:g} mm" if dp < 1.0 else f"{dp:.3g} m"
            label = f"{variant + ', ' if variant else ''}{preset}, dp = {spacing}"
            kept.setdefault((preset, variant), (label, f"{STYLES[preset]} dt {1 + variants.index(variant)}", json.loads(file.read_text())))
    folder.mkdir(parents=True, exist_ok=True)
    for name, by_run in found.items():
        draw(folder / f"{case.name}.{name}.svg", case.title, [by_run[run] for run in sorted(by_run)])
    return sorted(found)
