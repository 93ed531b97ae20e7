#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Memory of an analysis: that of the frames at hand, whatever the length of the run.

usage: memory.py SURGE_ANALYZE MAKE_RUN [DP [FRAMES]]
DP m of the test valley (default 3: about 11,000 particles; 0.66: a million), FRAMES of the long run (default 10).
A run of FRAMES is analysed, and its two largest neighbouring frames alone: the peak memory of the whole may be 10 % (and
4 MB) larger, no more. Prints time and memory of each command. Exit status 1 when that is not so.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile


def measure(command):
    """Peak resident memory (MB) and wall seconds of a command, in a process of its own that counts its children."""
    code = ("import resource, subprocess, sys, time; t = time.monotonic();"
            "code = subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode;"
            "print(code, resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024, time.monotonic() - t)")
    words = subprocess.run([sys.executable, "-c", code, *command], capture_output=True, text=True, check=True).stdout.split()
    if words[0] != "0":
        sys.exit(f"FAILED: {' '.join(command)} ended with {words[0]}")
    return float(words[1]), float(words[2])


def main():
    analyze, make_run = sys.argv[1:3]
    dp = sys.argv[3] if len(sys.argv) > 3 else "3"
    frames = int(sys.argv[4]) if len(sys.argv) > 4 else 10
    work = tempfile.mkdtemp(prefix="surge-analyze-memory.")
    failures = 0
    try:
        run = f"{work}/long.run"
        subprocess.run([make_run, f"{work}/long.case", run, dp, str(frames)], stdout=subprocess.DEVNULL, check=True)
        files = [f"{run}/frames/{f}" for f in sorted(os.listdir(f"{run}/frames")) if f.startswith("fluid")]
        sizes = [os.path.getsize(f) for f in files]
        largest = max(range(frames - 1), key=lambda k: sizes[k] + sizes[k + 1])
        interval = 20.0 / (frames - 1)  # s
        two = ["--from", f"{(largest - 0.5) * interval:g}", "--until", f"{(largest + 1.5) * interval:g}"]
        with open(files[largest], "rb") as file:
            particles = int(re.search(rb'NumberOfPoints="(\d+)"', file.read(20000)).group(1))
        print(f"{frames} frames of up to {particles} particles, {sizes[largest] / 2 ** 20:.0f} MB on disk")
        commands = {"runup": [], "front": [], "profile": [], "gauge": [], "energy": [], "map": ["-o", f"{work}/map"], "surface": ["-o", f"{work}/surface"]}
        for command, options in commands.items():
            short, _ = measure([analyze, command, run, *two, *options])
            long, seconds = measure([analyze, command, run, *options])
            print(f"{command}: {long:.0f} MB for {frames} frames, {short:.0f} MB for 2; {seconds / frames:.2f} s a frame")
            if long > 1.1 * short + 4.0:
                print(f"FAILED: {command}: memory grows with the number of frames", file=sys.stderr)
                failures += 1
    finally:
        shutil.rmtree(work)
    sys.exit(1 if failures else 0)


main()
