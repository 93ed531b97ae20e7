#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""bench/terrain_scene.py FOLDER: a large made-up scene to time mesh2particles on.

A valley of 262,144 triangles (binary STL, 2 km x 1 km), a lake in it, and a closed rigid slide of 66,044 triangles; as large as
the scene with which DualSPHysics' GenCase makes 14.2 million particles. dp = 1.4 m gives 14 million, 3.4 m a million.

example: python3 bench/terrain_scene.py /tmp/scene && build/bin/mesh2particles /tmp/scene/scene.toml -v -o /tmp/scene/a.case
"""
import math
import os
import struct
import sys

SCENE = """[resolution]
dp = 1.4
[terrain]
files = ["terrain.stl"]
[[fluid.fill]]
level = 50.0
seed = [1000.0, 512.0]
[[slide]]
kind = "rigid"
mesh = "slide.stl"
[domain]
wall_particles = "all"
"""


def smooth_ground(x, y):
    return 60.0 * ((y - 512.0) / 400.0) ** 2 + 0.02 * x + 3.0 * math.sin(x / 37.0) * math.sin(y / 53.0)


def write_stl(path, triangles):
    with open(path, "wb") as out:
        out.write(b" " * 80 + struct.pack("<I", len(triangles)))
        out.write(b"".join(struct.pack("<12fH", 0, 0, 0, *a, *b, *c, 0) for a, b, c in triangles))


def quads(point, nx, ny, up):
    for i in range(nx):
        for j in range(ny):
            a, b, c, d = point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)
            yield from ((a, b, c), (a, c, d)) if up else ((a, c, b), (a, d, c))


def slide(nx, ny):
    def point(top):
        def at(i, j):
            x, y = 900 + 200 * i / nx, 800 + 180 * j / ny
            lens = math.sin(math.pi * i / nx) * math.sin(math.pi * j / ny) if 0 < i < nx and 0 < j < ny else 0.0
            return x, y, smooth_ground(x, y) + 4 + (25 * lens + 0.02 if top else -2 * lens - 0.02)
        return at
    top, bottom = point(True), point(False)
    triangles = list(quads(top, nx, ny, True)) + list(quads(bottom, nx, ny, False))
    rim = [(i, 0) for i in range(nx)] + [(nx, j) for j in range(ny)] + [(i, ny) for i in range(nx, 0, -1)] + [(0, j) for j in range(ny, 0, -1)]
    for k, a in enumerate(rim):
        b = rim[(k + 1) % len(rim)]
        triangles += [(bottom(*a), bottom(*b), top(*b)), (bottom(*a), top(*b), top(*a))]
    return triangles


def main():
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        print(__doc__, end="")
        return 2
    os.makedirs(sys.argv[1], exist_ok=True)
    ground = lambda i, j: (4.0 * i, 4.0 * j, smooth_ground(4.0 * i, 4.0 * j) + 0.7 * math.sin(4.0 * i / 7.3 + 4.0 * j / 5.1))
    write_stl(os.path.join(sys.argv[1], "terrain.stl"), list(quads(ground, 512, 256, True)))
    write_stl(os.path.join(sys.argv[1], "slide.stl"), slide(127, 128))
    with open(os.path.join(sys.argv[1], "scene.toml"), "w") as out:
        out.write(SCENE)
    return 0


sys.exit(main())
