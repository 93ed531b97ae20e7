#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Each equation in three places: the law's comment in lib (`@eq tag`), a section `## tag` of docs/equations.md,
and a test that names it (`@eq tag` in a comment). Fails when one of the three lacks a tag that another has, or when
the law's comment lacks its formula (an equals sign), a unit (`[m/s]`; `[1]`: none) or its source (`Source: ...`).

usage: check_equations.py [repository root]

Exit status: 0 when all agree, 1 with one line for each thing missing, 2 when no tag is found at all.
"""
import pathlib
import re
import sys

TAG = re.compile(r"@eq\s+([a-z][a-z0-9_]*(?:[.-][a-z0-9_]+)*)")
SECTION = re.compile(r"^##\s+`?([a-z][a-z0-9_]*(?:[.-][a-z0-9_]+)+)`?\s*$", re.M)
PARTS = {"formula": re.compile(r"="), "unit ([m/s])": re.compile(r"\[[^\]]+\]"), "source (Source: ...)": re.compile(r"Sources?:")}
SOURCES = {".hpp", ".cpp", ".cuh", ".cu", ".h", ".py"}


def tags_in(folder, root, without=()):
    """Tag -> first place it stands in, for the sources under a folder, some folders left out."""
    found = {}
    for path in sorted(folder.rglob("*")) if folder.is_dir() else []:
        if path.suffix in SOURCES and not set(without) & set(path.parents):
            text = path.read_text(encoding="utf-8", errors="replace")
            for match in TAG.finditer(text):
                line = text.count("\n", 0, match.start()) + 1
                found.setdefault(match.group(1), f"{path.relative_to(root)}:{line}")
    return found


def laws_in(folder, root):
    """(tag, place, text) of each law: what its comment says from the tag to the next one or to the end of the comment."""
    for path in sorted(folder.rglob("*")) if folder.is_dir() else []:
        if path.suffix not in SOURCES:
            continue
        law = None
        for number, line in enumerate(path.read_text(encoding="utf-8", errors="replace").splitlines() + [""], 1):
            comment = re.match(r"\s*//+(.*)", line)
            tag = TAG.search(comment.group(1)) if comment else None
            if law and (tag or not comment):
                yield tuple(law)
                law = None
            if tag:
                law = [tag.group(1), f"{path.relative_to(root)}:{number}", comment.group(1)[tag.end():]]
            elif law:
                law[2] += "\n" + comment.group(1)


def sections_in(page, root):
    if not page.is_file():
        return {}
    text = page.read_text(encoding="utf-8")
    return {match.group(1): f"{page.relative_to(root)}:{text.count(chr(10), 0, match.start()) + 1}"
            for match in SECTION.finditer(text)}


def check(root):
    """Returns (tags of lib, list of what is missing)."""
    laws = tags_in(root / "lib", root)
    sections = sections_in(root / "docs" / "equations.md", root)
    tests = tags_in(root / "tests", root, without=[root / "tests" / "unit" / "house"])
    missing = []
    for tag, place in sorted(laws.items()):
        if tag not in sections:
            missing.append(f"{place}: {tag} has no section '## {tag}' in docs/equations.md")
        if tag not in tests:
            missing.append(f"{place}: {tag} is named by no test (a comment '@eq {tag}' under tests/)")
    for places, what in ((sections, "a section"), (tests, "a test")):
        missing += [f"{place}: {what} for {tag}, which no law in lib carries"
                    for tag, place in sorted(places.items()) if tag not in laws]
    for tag, place, text in laws_in(root / "lib", root):
        missing += [f"{place}: {tag} says no {part}" for part, pattern in PARTS.items() if not pattern.search(text)]
    return laws, missing


def main(arguments):
    root = pathlib.Path(arguments[0] if arguments else pathlib.Path(__file__).parent.parent).resolve()
    laws, missing = check(root)
    if not laws and not missing:
        print(f"check_equations.py: no '@eq tag' under {root}/lib", file=sys.stderr)
        return 2
    for line in missing:
        print(line)
    print(f"{len(laws)} equations, {len(missing)} things missing")
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
