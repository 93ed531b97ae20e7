# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tests of gdesp-run share: a folder, cases, runs, comparisons."""
import filecmp
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

gdesp_run, make_case = (os.path.abspath(p) for p in sys.argv[1:3])
environment = dict(os.environ, GOMP_SPINCOUNT="1000")


def has_address_sanitizer():
    """Of gdesp-run: it bears no limit on its address space or data."""
    return b"libasan" in subprocess.run(["ldd", gdesp_run], capture_output=True).stdout


class RunCase(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="gdesp-run-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def case(self, *kinds, dp="0.01", name="c.case"):
        subprocess.run([make_case, name, dp, *kinds], cwd=self.folder, check=True)
        return name

    def start(self, *arguments, **options):
        settings = dict(cwd=self.folder, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        settings.update(options)
        return subprocess.Popen([gdesp_run, *arguments], **settings)

    def run_tool(self, *arguments, input=None, **options):
        process = self.start(*arguments, stdin=subprocess.PIPE, **options)
        out, err = process.communicate(input or "", timeout=100)
        return process.returncode, out, err

    def run_well(self, *arguments, **options):
        code, out, err = self.run_tool(*arguments, **options)
        self.assertEqual(code, 0, err)
        return [json.loads(line) for line in out.splitlines()], err

    def frames(self, run):
        return sorted(p.name for p in (self.folder / run / "frames").iterdir())

    def assert_same_run(self, one, other):
        """The same frames, byte by byte, and the same log."""
        self.assertEqual(self.frames(one), self.frames(other))
        self.assertGreater(len(self.frames(one)), 1)
        for name in self.frames(one):
            same = filecmp.cmp(self.folder / one / "frames" / name, self.folder / other / "frames" / name, shallow=False)
            self.assertTrue(same, f"{name} differs")
        for name in ("log.ndjson", "fluid.pvd"):
            self.assertEqual((self.folder / one / name).read_bytes(), (self.folder / other / name).read_bytes(), name)

    def log(self, run):
        return [json.loads(line) for line in (self.folder / run / "log.ndjson").read_text().splitlines()]


def main():
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
