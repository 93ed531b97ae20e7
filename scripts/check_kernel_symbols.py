#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Kernel sources are compiled once per back end: what they define must bear it (templates, inline or internal).

usage: check_kernel_symbols.py ARCHIVE SOURCE.cpp...

A plain function with external linkage in a kernel source links well without CUDA and is a "multiple definition" with it,
which a machine without the CUDA Toolkit would not notice. ARCHIVE is the solver library; its members SOURCE.cpp.o are read
with `nm`. Exit status: 0 when none defines a strong symbol, 1 with one line a symbol, 2 when there is nothing to check.
"""
import pathlib
import re
import subprocess
import sys

STRONG = set("TDBRSG")
LINE = re.compile(r"^[^:]+:([^:]+):[0-9a-f]* (\w) (.+)$")


def strong_symbols(listing, members):
    """[(member, symbol)] of the strong symbols that `nm -A` lists for these members, and the members seen."""
    found, seen = [], set()
    for line in listing.splitlines():
        match = LINE.match(line)
        if match and match.group(1) in members:
            seen.add(match.group(1))
            if match.group(2) in STRONG:
                found.append((match.group(1), match.group(3)))
    return found, seen


def main(arguments):
    if len(arguments) < 2:
        sys.exit(__doc__)
    members = {pathlib.PurePath(source).name + ".o" for source in arguments[1:]}
    listing = subprocess.run(["nm", "-A", "--demangle", "--defined-only", "--extern-only", arguments[0]],
                             check=True, capture_output=True, text=True).stdout
    found, seen = strong_symbols(listing, members)
    for member, symbol in found:
        print(f"{member[:-2]}: {symbol} is defined once per back end; make it a template, inline or internal, "
              "or move it to a plain source")
    if not found and seen != members:
        print(f"{arguments[0]} does not hold {', '.join(sorted(members - seen))}")
        return 2
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
