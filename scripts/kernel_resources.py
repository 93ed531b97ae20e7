#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Registers, spills and occupancy of the CUDA kernels, from what ptxas said in a build log.

usage: kernel_resources.py BUILD_LOG [--arch sm_90] [--all] [--strict]

Prints a table: kernel (the body that it runs), registers a thread, bytes spilled, share of the resident warps that the
registers allow at 128 threads a block (65,536 registers and 64 warps a multiprocessor: sm_80, sm_90). Kernels of CUB are
left out unless --all. Exit status: 0, 1 with --strict when a kernel spills, 2 when the log holds no such lines.
"""
import argparse
import re
import signal
import subprocess
import sys

REGISTERS, WARPS, BLOCK_WARPS, UNIT = 65536, 64, 4, 256
ENTRY = re.compile(r"Compiling entry function '([^']+)' for '([^']+)'")
SPILL = re.compile(r"(\d+) bytes spill stores, (\d+) bytes spill loads")
USED = re.compile(r"Used (\d+) registers")


def occupancy(registers):
    """Share of the warps of a multiprocessor that can be resident."""
    a_warp = -(-registers * 32 // UNIT) * UNIT
    blocks = REGISTERS // a_warp // BLOCK_WARPS
    return min(WARPS, blocks * BLOCK_WARPS) / WARPS


def kernels(log, arch):
    """(mangled name, registers, spilled bytes) of each entry function for the architecture, once each."""
    found, name, spilled = {}, None, 0
    for line in log:
        if match := ENTRY.search(line):
            name, spilled = (match.group(1), 0) if match.group(2) == arch else (None, 0)
        elif match := SPILL.search(line):
            spilled = int(match.group(1)) + int(match.group(2))
        elif (match := USED.search(line)) and name:
            found[name], name = (int(match.group(1)), spilled), None
    return found


def short(name):
    """The body that a kernel runs, without namespaces and the scaffolding around it."""
    match = re.search(r"run_(parallel_for|pair_pass|row_pass)<(.*)>\(", name)
    body = f"{match.group(2)} [{match.group(1)}]" if match else name
    return re.sub(r"\(anonymous namespace\)::|gdesp::(?:\w+::)*|\(int\)|\(bool\)", "", body)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("log", type=argparse.FileType("r", errors="replace"))
    parser.add_argument("--arch", default="sm_90")
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--strict", action="store_true")
    options = parser.parse_args()
    found = kernels(options.log, options.arch)
    if not found:
        print(f"kernel_resources.py: {options.log.name}: nothing was compiled for {options.arch} with --resource-usage", file=sys.stderr)
        return 2
    names = subprocess.run(["c++filt"], input="\n".join(found), capture_output=True, text=True, check=True).stdout.splitlines()
    rows = {(short(name), *use) for name, use in zip(names, found.values()) if options.all or "gdesp::exec::detail::run_" in name}
    print("kernel\tregisters\tspilled[B]\toccupancy[%]")
    for name, registers, spilled in sorted(rows, key=lambda row: (-row[1], row[0])):
        print(f"{name}\t{registers}\t{spilled}\t{100 * occupancy(registers):.0f}")
    return 1 if options.strict and any(spilled for _, _, spilled in rows) else 0


if __name__ == "__main__":
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    sys.exit(main())
