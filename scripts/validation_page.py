# SPDX-License-Identifier: GPL-3.0-or-later
"""The table docs/validation.tsv and the page docs/validation.md, which is made from the table alone."""
import math

COLUMNS = ["case", "reference", "metric", "unit", "preset", "dp", "value", "reference value", "error", "band",
           "accepted", "cost", "made by"]
ENERGY = "energy that nothing gave, of what there was to spend"
MOMENTUM = "momentum of the closed system gained, of mass times largest speed"
BUDGETS = (ENERGY, MOMENTUM)


def read_table(path):
    if not path.exists():
        return []
    lines = path.read_text().splitlines()
    names = lines[0].split("\t")
    return [dict.fromkeys(COLUMNS, "") | dict(zip(names, line.split("\t"))) for line in lines[1:]]


def write_table(path, rows):
    text = "\t".join(COLUMNS) + "\n" + "".join("\t".join(row[c] for c in COLUMNS) + "\n" for row in rows)
    path.with_suffix(".tmp").write_text(text)
    path.with_suffix(".tmp").replace(path)


def merge(old, new, names):
    """New rows take the place of old ones of the same case, preset and spacing. Ordered by case, spacing and preset, so that
    tables of two people differ only where they measured differently; cases and variants that are no more (not in `names`) are left out."""
    renewed = {(row["case"], row["preset"], row["dp"]) for row in new}
    rows = [row for row in old if (row["case"], row["preset"], row["dp"]) not in renewed] + new
    rows = [row for row in rows if row["case"] in names]
    return sorted(rows, key=lambda row: (row["case"].split("/")[0], row["case"], -float(row["dp"]), row["preset"]))


def number(text):
    try:
        return float(text)
    except ValueError:
        return math.nan


def observed_order(spacings, values):
    """Order p, and the error bar of the finest value (grid convergence index with factor 1.25), from the three finest.

    None when the values do not converge monotonically. Celik et al. (2008), J. Fluids Eng. 130, 078001,
    doi:10.1115/1.2960953."""
    h3, h2, h1 = spacings[-3:]
    f3, f2, f1 = values[-3:]
    e32, e21 = f3 - f2, f2 - f1
    if e21 == 0.0 or e32 / e21 <= 1.0:
        return None
    r21, r32 = h2 / h1, h3 / h2
    p = math.log(e32 / e21) / math.log(r21)
    for _ in range(50):
        try:
            q = math.log((r21 ** p - 1.0) / (r32 ** p - 1.0))
            p = abs(math.log(e32 / e21) + q) / math.log(r21)
        except (ValueError, OverflowError, ZeroDivisionError):
            return None
    if p < 1e-3:
        return None
    return p, 1.25 * abs(e21) / (r21 ** p - 1.0)


def order_of_error(spacings, errors):
    """Slope of log |error| over log dp, by least squares over the three finest; None where an error vanishes."""
    points = [(math.log(h), math.log(abs(e))) for h, e in zip(spacings[-3:], errors[-3:]) if e != 0.0 and math.isfinite(e)]
    if len(points) < 3:
        return None
    mean_h, mean_e = (sum(p[k] for p in points) / len(points) for k in (0, 1))
    return sum((h - mean_h) * (e - mean_e) for h, e in points) / sum((h - mean_h) ** 2 for h, _ in points)


def cells(*texts):
    return "| " + " | ".join(str(t).replace("|", "\\|") for t in texts) + " |\n"


def head_line(*texts):
    return cells(*texts) + "|" + "---|" * len(texts) + "\n"


def grouped(rows, *columns):
    """Rows by the values of some columns, in the order in which they come, each by spacing."""
    groups = {}
    for row in rows:
        groups.setdefault(tuple(row[c] for c in columns), {})[row["dp"]] = row
    return groups


def orders(by_spacing, there):
    """What the page says of convergence: order of the values, its error bar, order of the error."""
    values, errors = ([number(by_spacing[dp][c]) for dp in there] for c in ("value", "error"))
    if len(there) < 3 or not all(map(math.isfinite, values)):
        return "", "", ""
    spacings = [float(dp) for dp in there]
    found, slope = observed_order(spacings, values), order_of_error(spacings, errors)
    order, bar = (f"{found[0]:.2f}", f"{found[1]:.2g}") if found else ("none", "")
    return order, bar, "" if slope is None else f"{slope:.2f}"


def case_section(case, rows, pictures):
    """The part of one case; `pictures`: file names in docs/validation."""
    text = f"## {case.name}\n\n{case.id}: {case.title}. {case.reference}\n\n"
    spacings = sorted({row["dp"] for row in rows}, key=float, reverse=True)
    text += head_line("case", "metric", "preset", *(f"dp {dp}" for dp in spacings), "reference", "error (finest)", "band",
                      "accepted", "order", "error bar", "order of error")
    for (name, metric, unit, preset), by_spacing in grouped(rows, "case", "metric", "unit", "preset").items():
        if metric in BUDGETS:
            continue
        there = [dp for dp in spacings if dp in by_spacing]
        finest = by_spacing[there[-1]]
        text += cells(name, f"{metric} [{unit}]", preset, *(by_spacing[dp]["value"] if dp in by_spacing else "" for dp in spacings),
                      finest["reference value"], finest["error"], finest["band"], finest["accepted"],
                      *orders(by_spacing, there))
    costs = grouped(rows, "case", "preset")
    text += "\nCost: " + "; ".join(f"{name} {preset}: " + ", ".join(f"{row['cost']} at dp {dp}" for dp, row in by.items())
                                   for (name, preset), by in costs.items()) + ".\n"
    text += "\nMade by " + "; ".join(dict.fromkeys(row["made by"] for row in rows if row["made by"])) + ".\n"
    return text + "".join(f"\n![{name.removesuffix('.svg')}](validation/{name})\n" for name in pictures)


HEAD = """# Validation

Written by `scripts/validate` (`--help`). Each row compares one number of a run with an exact solution or an experiment: error in
the metric's own terms, accepted when it is within the band that stood in `data/cases/NAME/measure.py` before the run. The whole table,
with the errors at every resolution, is [validation.tsv](validation.tsv); this page is made from it. `order`: observed order of convergence
of the value over the three finest resolutions, `error bar`: its grid convergence index (Celik et al. 2008); "none" where the values do not
converge monotonically. `order of error`: slope of log error over log dp, the same three. Cost: processor seconds of the
simulation (rows older than commit 3cd2543: wall seconds times threads, on a shared machine). dp in metres. What was tried for the rows that are not accepted is in [decisions/0031](decisions/0031-water-options-measured.md); of dry grains in [decisions/0045](decisions/0045-dry-grains-against-experiments.md).

"""


def finest_rows(rows, preset):
    """What is judged: the finest of each metric; what is only stated (no reference has a number for it) is left out, and budgets."""
    best = {}
    for row in rows:
        key = (row["case"], row["metric"])
        if row["preset"] != preset or row["accepted"] == "stated" or row["metric"] in BUDGETS:
            continue
        if key not in best or float(row["dp"]) < float(best[key]["dp"]):
            best[key] = row
    return list(best.values())


def summary_text(rows):
    parts = []
    for preset in sorted({row["preset"] for row in rows}):
        finest = finest_rows(rows, preset)
        parts.append(f"{sum(row['accepted'] == 'yes' for row in finest)} of {len(finest)} metrics accepted with `{preset}`")
    return "At the finest resolution run: " + ", ".join(parts) + ".\n\n" if parts else ""


def commits_text(rows):
    """Which commit most of the runs are of, and which runs are of others."""
    runs = {(row["case"], row["preset"], row["dp"]): row["made by"].removeprefix("commit ").split(",")[0] or "unknown" for row in rows}
    if not runs:
        return ""
    commits = list(runs.values())
    most = max(dict.fromkeys(commits), key=commits.count)
    others = {}
    for (case, preset, dp), commit in runs.items():
        if commit != most:
            others.setdefault(commit, {}).setdefault(f"{case} {preset}", []).append(dp)
    listed = "; ".join(f"{commit}: " + ", ".join(f"{case} {' '.join(dp)}" for case, dp in of.items()) for commit, of in others.items())
    return f"Of {len(runs)} runs {commits.count(most)} are of commit {most}" + (f"; of others (dp in metres) {listed}" if listed else "") + ".\n\n"


def halved_pairs(rows):
    """(row of `accurate` at about 2 dp, row of `paper` at dp or None where that run failed) of every metric run so."""
    paper = {}
    for row in rows:
        if row["preset"] == "paper":
            paper.setdefault(row["case"], []).append(row)
    pairs = []
    for row in rows:
        if row["preset"] != "accurate" or row["accepted"] == "stated" or row["metric"] in BUDGETS:
            continue
        fine = [p for p in paper.get(row["case"], []) if abs(2.0 * float(p["dp"]) / float(row["dp"]) - 1.0) < 0.01]
        same = [p for p in fine if p["metric"] == row["metric"]]
        if same or any(p["metric"] == "run ends" for p in fine):
            pairs.append((row, same[0] if same else None))
    return pairs


def halved_text(rows):
    pairs = halved_pairs(rows)
    if not pairs:
        return ""
    good = lambda row, fine: fine is None or not abs(number(fine["error"])) < abs(number(row["error"]))
    text = ("## `accurate` at 2 dp beside `paper` at dp\n\nAn eighth of the particles in space, a quarter in the plane. At least as accurate in "
            f"{sum(good(*pair) for pair in pairs)} of {len(pairs)} metrics:\n\n")
    text += head_line("case", "metric", "accurate at dp", "error", "paper at dp", "error", "at least as accurate")
    for row, fine in pairs:
        text += cells(row["case"], row["metric"], row["dp"], row["error"], fine["dp"] if fine else "half of it",
                      fine["error"] if fine else "the run fails", "yes" if good(row, fine) else "no")
    return text + "\n"


def budget_text(rows):
    """The budgets of every run that has them."""
    table = {}
    for row in rows:
        if row["metric"] in BUDGETS:
            table.setdefault((row["case"], row["preset"], row["dp"]), {})[row["metric"]] = row
    if not table:
        return ""
    count = lambda metric, preset: [row[metric]["accepted"] == "yes" for key, row in table.items() if key[1] == preset and metric in row]
    text = ("## Budgets\n\nEnergy: the largest rise of kinetic, potential and elastic energy of water, grains and bodies above its lowest value before, over "
            "what there was to spend (kinetic and elastic at the start, potential set free so far, the weight of all over one dp); of runs in "
            "which nothing works on the particles from outside. Momentum: of runs without walls and forces. From the run's `log.ndjson`: a line every 10 steps in "
            "rows of programs younger than commit 080022b ([0048](decisions/0048-walls-among-grains.md)), every 100 in older ones, which do not see short bursts.\n\n")
    for preset in sorted({key[1] for key in table}):
        energy, momentum = count(ENERGY, preset), count(MOMENTUM, preset)
        text += (f"`{preset}`: no more than 0.1 % of energy created in {sum(energy)} of {len(energy)} runs, momentum kept to 1e-5 in "
                 f"{sum(momentum)} of {len(momentum)}.\n")
    text += "\n" + head_line("case", "preset", "dp", "energy created", "momentum gained")
    for (case, preset, dp), row in table.items():
        shown = [f"{100.0 * number(row[ENERGY]['value']):.3g} %" if ENERGY in row else "", row[MOMENTUM]["value"] if MOMENTUM in row else ""]
        text += cells(case, preset, dp, *shown)
    return text + "\n"


def write_page(path, cases, rows):
    text = HEAD + summary_text(rows) + commits_text(rows) + halved_text(rows) + budget_text(rows)
    for case in cases:
        own = [row for row in rows if row["case"].split("/")[0] == case.name]
        pictures = sorted(file.name for file in (path.parent / "validation").glob(f"{case.name}.*.svg"))
        if own:
            text += case_section(case, own, pictures) + "\n"
    path.write_text(text.rstrip("\n") + "\n")
