#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
import unittest

from tree import TreeTest


class CheckEquations(TreeTest):
    script = "check_equations"
    law = "// @eq sph.eos.tait\n//   P = B (R^7 - 1); P: pressure [Pa]. Source: Tait (1888).\n#pragma once\n"

    def setUp(self):
        super().setUp()
        self.write("lib/sph/tait.hpp", self.law)
        self.write("docs/equations.md", "# Equations\n\n## Notation\n\n## sph.eos.tait\n")
        self.write("tests/unit/sph/test_tait.cpp", "// @eq sph.eos.tait: hand value\n")

    def test_all_three(self):
        self.assert_clean()

    def test_no_section(self):
        self.write("docs/equations.md", "# Equations\n\n## Notation\n")
        self.assert_finds("lib/sph/tait.hpp:1: sph.eos.tait has no section")

    def test_no_page(self):
        (self.root / "docs/equations.md").unlink()
        self.assert_finds("has no section")

    def test_no_test(self):
        self.write("tests/unit/sph/test_tait.cpp", "// nothing\n")
        self.assert_finds("sph.eos.tait is named by no test")

    def test_test_of_an_unknown_law(self):
        self.write("tests/unit/dem/test_hertz.cpp", "\n// @eq dem.hertz.normal\n")
        self.assert_finds("tests/unit/dem/test_hertz.cpp:2: a test for dem.hertz.normal")

    def test_section_of_an_unknown_law(self):
        self.write("docs/equations.md", "## sph.eos.tait\n## dem.hertz.normal\n")
        self.assert_finds("docs/equations.md:2: a section for dem.hertz.normal")

    def test_this_folder_names_tags_without_testing_them(self):
        self.write("tests/unit/house/test_check_equations.py", "# @eq sph.eos.tait\n# @eq dem.hertz.normal\n")
        self.assert_clean()
        (self.root / "tests/unit/sph/test_tait.cpp").unlink()
        self.assert_finds("sph.eos.tait is named by no test")

    def test_formula_unit_and_source(self):
        for part, without in (("formula", self.law.replace("=", "is")), ("unit", self.law.replace("[Pa]", "in Pa")),
                              ("source", self.law.replace("Source: ", ""))):
            self.write("lib/sph/tait.hpp", without + "// Source: of the next comment, a = b [m].\n")
            self.assert_finds(f"lib/sph/tait.hpp:1: sph.eos.tait says no {part}")

    def test_each_law_of_a_comment_says_its_own(self):
        self.write("lib/sph/tait.hpp", "// @eq sph.eos.tait\n//   P = 0\n" + self.law.replace("tait", "other"))
        self.assert_finds("lib/sph/tait.hpp:1: sph.eos.tait says no source")

    def test_sentence_end_is_no_part_of_a_tag(self):
        self.write("lib/sph/tait.hpp", "// the law of @eq sph.eos.tait. P = 0 [Pa]; Source: Tait.\n")
        self.assert_clean()

    def test_nothing_to_check_is_no_success(self):
        for path in list(self.root.rglob("*.*")):
            path.unlink()
        self.assertEqual(self.run_check()[0], 2)


if __name__ == "__main__":
    unittest.main()
