# SPDX-License-Identifier: GPL-3.0-or-later
"""A small source tree in a temporary folder, for the tests of the checks; the scripts folder comes as argument 1."""
import contextlib
import importlib
import io
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, sys.argv.pop(1))


class TreeTest(unittest.TestCase):
    script = ""  # name of the check's module

    def setUp(self):
        self.check = importlib.import_module(self.script)
        self.folder = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    def write(self, path, text):
        target = self.root / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(text, encoding="utf-8")

    def run_check(self, *options):
        """(exit status, what it printed)."""
        out = io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(out):
            status = self.check.main([*options, str(self.root)])
        return status, out.getvalue()

    def assert_clean(self, *options):
        status, text = self.run_check(*options)
        self.assertEqual(status, 0, text)

    def assert_finds(self, what, *options):
        status, text = self.run_check(*options)
        self.assertEqual(status, 1, text)
        self.assertIn(what, text)
