#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Who may include whom (docs/architecture.md): fails when a file of lib/ or tools/ includes past its module's reach.

usage: check_includes.py [repository root]

Rules:
  modules     a file includes headers of its own module and of those that MAY_INCLUDE names for it
  laws        a header of dem, sph or coupling with an `@eq tag` comment and the formula itself (GDESP_HD functions)
              reaches nothing but core, the standard library and other such headers of its module: it can be tested
              on paper. A tag may also stand at a sum over particles, which needs them: no law header.
  solver      the solver modules include no third party's headers; CUDA, CUB and OpenMP stay in exec
  heavy       CGAL, OpenVDB, gmsh and toml++ are slow to compile: never in a header that another module includes
  tools       a tool includes lib and itself, never another tool
Exit status: 0 when all hold, 1 with one line a violation, 2 when there is nothing to check.
"""
import pathlib
import re
import sys

SOLVER = ("core", "exec", "particles", "neighbors", "sph", "dem", "coupling", "simulation")
BELOW_PHYSICS = {"core", "exec", "particles", "neighbors"}
MAY_INCLUDE = {
    "core": set(),
    "exec": {"core"},
    "particles": {"core", "exec"},
    "neighbors": {"core", "exec", "particles"},
    "sph": BELOW_PHYSICS,
    "dem": BELOW_PHYSICS,
    "coupling": BELOW_PHYSICS | {"sph", "dem"},
    "simulation": BELOW_PHYSICS | {"sph", "dem", "coupling"},
    "scene": {"core", "particles"},
    "io": {"core", "particles", "scene"},
    "cli": {"core", "scene"},
    "geometry": {"core", "particles", "scene", "io"},
    "analysis": {"core", "particles", "scene", "io", "geometry"},
}
TOOLS = {
    "mesh2particles": {"core", "particles", "scene", "io", "cli", "geometry", "dem"},
    "gdesp-run": set(SOLVER) | {"scene", "io", "cli"},
    "surge-analyze": {"core", "particles", "scene", "io", "cli", "analysis"},
}
DEVICE = re.compile(r"^(cuda|cub/|thrust/|cooperative_groups|nvtx|omp\.h$|nv/)")
THIRD_PARTY = re.compile(r"^(CGAL|openvdb|nanovdb|gmsh|toml\+\+|vtk|boost|nlohmann|Eigen|gdal|ogr|cpl_|tbb|fmt)")
HEAVY = re.compile(r"^(CGAL/|openvdb/|gmsh|toml\+\+/)")
SOURCES = {".hpp", ".cpp", ".cuh", ".cu", ".h"}
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"])([^>"]+)[>"]', re.M)
LAW = re.compile(r"@eq\s+[a-z]")


def without_comments(text):
    """The code of a file: comments blanked, line breaks kept."""
    return re.sub(r"//[^\n]*|/\*.*?\*/", lambda match: "\n" * match.group().count("\n"), text, flags=re.S)


class Checker:
    def __init__(self, root):
        self.root, self.lib, self.violations, self.files = root, root / "lib", [], 0
        self.modules = {path.name for path in self.lib.iterdir() if path.is_dir()} if self.lib.is_dir() else set()

    def say(self, path, line, message):
        self.violations.append(f"{path.relative_to(self.root)}:{line}: {message}")

    def module_of(self, path, kind, target):
        """The module of lib that an include names, or None: "sph/tait_eos.hpp", or a header next to the file."""
        first = target.split("/")[0]
        if "/" in target and first in self.modules | {"core"}:
            return first
        beside = (path.parent / target).resolve()
        if kind == '"' and beside.is_file() and self.lib.resolve() in beside.parents:
            return beside.relative_to(self.lib.resolve()).parts[0]
        return None

    def check_lib_file(self, path, module):
        text = path.read_text(encoding="utf-8", errors="replace")
        code = without_comments(text)
        is_law = (path.suffix == ".hpp" and module in ("sph", "dem", "coupling") and LAW.search(text)
                  and "GDESP_HD" in code)
        for match in INCLUDE.finditer(code):
            line, kind, target = code.count("\n", 0, match.start()) + 1, match.group(1), match.group(2)
            other = self.module_of(path, kind, target)
            if other and other != module and other not in MAY_INCLUDE.get(module, set()):
                self.say(path, line, f'{module} may not include {other} ("{target}")')
            if is_law and kind == '"' and other != "core" and not self.reaches_core_only(module, target):
                self.say(path, line, f'a law header reaches core only, not what "{target}" brings')
            if DEVICE.match(target) and module in SOLVER and module != "exec":
                self.say(path, line, f"<{target}> belongs in lib/exec")
            if THIRD_PARTY.match(target) and module in SOLVER:
                self.say(path, line, f"the solver needs no third party: <{target}>")
            if path.suffix == ".hpp" and HEAVY.match(target):
                self.note_heavy(path, line, target)
        if module in SOLVER and module != "exec":
            for match in re.finditer(r"^[ \t]*#[ \t]*pragma[ \t]+omp[ \t]+(?!simd|declare)", code, re.M):
                self.say(path, code.count("\n", 0, match.start()) + 1, "OpenMP threads belong in lib/exec")

    def reaches_core_only(self, module, target, seen=()):
        """Does a header of the module include, all the way down, nothing but core and the standard library?"""
        header = self.lib / target
        if not target.startswith(module + "/") or not header.is_file():
            return False
        code = without_comments(header.read_text(encoding="utf-8", errors="replace"))
        return all(next_.startswith("core/") or next_ in seen or
                   self.reaches_core_only(module, next_, seen + (target,))
                   for kind, next_ in INCLUDE.findall(code) if kind == '"')

    def note_heavy(self, path, line, target):
        """A header with a slow include is fine while only its own module uses it."""
        module = path.relative_to(self.lib).parts[0]
        name = path.relative_to(self.lib).as_posix()
        for other in self.sources(self.lib) + self.sources(self.root / "tools"):
            home = other.relative_to(self.root).parts
            if home[:2] != ("lib", module) and f'"{name}"' in other.read_text(encoding="utf-8", errors="replace"):
                self.say(path, line, f"<{target}> in a header that {other.relative_to(self.root)} includes")

    def check_tool_file(self, path, tool):
        code = without_comments(path.read_text(encoding="utf-8", errors="replace"))
        for match in INCLUDE.finditer(code):
            line, kind, target = code.count("\n", 0, match.start()) + 1, match.group(1), match.group(2)
            first = target.split("/")[0]
            if "/" in target and kind == '"' and first in self.modules and first not in TOOLS.get(tool, set()):
                self.say(path, line, f'{tool} may not include {first} ("{target}")')
            if kind == '"' and (first == "tools" or (target.startswith("../") and "lib" not in target)):
                self.say(path, line, f'a tool includes lib and itself, not "{target}"')

    @staticmethod
    def sources(folder):
        return sorted(path for path in folder.rglob("*") if path.suffix in SOURCES) if folder.is_dir() else []

    def run(self):
        for module in sorted(self.modules - set(MAY_INCLUDE)):
            if self.sources(self.lib / module):
                self.violations.append(f"lib/{module}: a module that MAY_INCLUDE in scripts/check_includes.py does not know")
        for path in self.sources(self.lib):
            self.files += 1
            self.check_lib_file(path, path.relative_to(self.lib).parts[0])
        for tool in TOOLS:
            for path in self.sources(self.root / "tools" / tool):
                self.files += 1
                self.check_tool_file(path, tool)
        return self.violations


def main(arguments):
    root = pathlib.Path(arguments[0] if arguments else pathlib.Path(__file__).parent.parent).resolve()
    checker = Checker(root)
    violations = checker.run()
    if not checker.files:
        print(f"check_includes.py: no source file under {root}/lib", file=sys.stderr)
        return 2
    for violation in violations:
        print(violation)
    print(f"{checker.files} files, {len(violations)} forbidden includes")
    return 1 if violations else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
