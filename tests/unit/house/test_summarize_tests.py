#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
import unittest

from tree import TreeTest

PASSING = """[ RUN      ] A.one
[       OK ] A.one (0 ms)
[ RUN      ] A.two
words of the program without a line end[       OK ] A.two (3 ms)
[==========] 2 tests from 1 test suite ran. (3 ms total)
"""
SKIPPING = """[ RUN      ] A.one
[       OK ] A.one (0 ms)
[ RUN      ] A.two
/somewhere/test.cpp:12: Skipped
no GPU seen
[  SKIPPED ] A.two (0 ms)
[==========] 2 tests from 1 test suite ran. (0 ms total)
[  SKIPPED ] 1 test, listed below:
[  SKIPPED ] A.two
"""
FAILING = """[ RUN      ] All/B.one/1
test.cpp:3: Failure
[  FAILED  ] All/B.one/1, where GetParam() = 2 (0 ms)
[==========] 1 test from 1 test suite ran. (0 ms total)
[  FAILED  ] 1 test, listed below:
[  FAILED  ] All/B.one/1, where GetParam() = 2
"""
CRASHING = "[ RUN      ] C.one\n[       OK ] C.one (0 ms)\n[ RUN      ] C.two\n"


def entry(name, status, output="", child=""):
    return f'<testcase name="{name}" status="{status}"><system-out>{output}</system-out>{child}</testcase>'


class SummarizeTests(TreeTest):
    script = "summarize_tests"

    def summary(self, *entries):
        self.write("results.xml", "<testsuite>" + "".join(entries) + "</testsuite>")
        self.root = self.root / "results.xml"
        status, text = self.run_check()
        self.root = self.root.parent
        return status, text

    def last_line(self, *entries):
        status, text = self.summary(*entries)
        return status, text.splitlines()[-1]

    def test_passing(self):
        self.assertEqual(self.last_line(entry("unit_a", "run", PASSING), entry("cli_a", "run", "fine")),
                         (0, "3 passed, 0 failed, 0 skipped"))

    def test_skipped_case_of_a_passing_program(self):
        status, text = self.summary(entry("unit_a", "run", SKIPPING))
        self.assertEqual(status, 0)
        self.assertIn("no GPU seen\n    unit_a: A.two\n", text)
        self.assertTrue(text.endswith("1 passed, 0 failed, 1 skipped\n"), text)

    def test_script_that_skips_itself(self):
        status, text = self.summary(
            entry("unit_a", "run", PASSING),
            entry("cli_a", "notrun", "words\nSKIP: no display\n", '<skipped message="SKIP_RETURN_CODE=77"/>'))
        self.assertEqual(status, 0)
        self.assertIn("SKIP: no display\n    cli_a\n2 passed, 0 failed, 1 skipped\n", text)

    def test_all_skipped_is_no_success(self):
        self.assertEqual(self.last_line(entry("gpu_a", "notrun", "", '<skipped message="SKIP_RETURN_CODE=77"/>'))[0], 1)

    def test_missing_program_is_a_failure(self):
        status, text = self.summary(entry("cli_a", "notrun", "", '<skipped message="Unable to find executable"/>'))
        self.assertEqual(status, 1)
        self.assertIn("cli_a: not run (Unable to find executable)\n0 passed, 1 failed, 0 skipped", text)

    def test_failing(self):
        failure = '<failure message=""/>'
        status, text = self.summary(entry("unit_b", "fail", FAILING, failure), entry("cli_b", "fail", "", failure),
                                    entry("unit_c", "fail", CRASHING, failure))
        self.assertEqual(status, 1)
        for line in ("unit_b: All/B.one/1", "cli_b", "unit_c: ended inside C.two"):
            self.assertIn(f"  {line}\n", text)
        self.assertTrue(text.endswith("1 passed, 3 failed, 0 skipped\n"), text)

    def test_program_that_fails_after_its_tests(self):
        self.assertEqual(self.last_line(entry("unit_a", "fail", PASSING, '<failure message=""/>')),
                         (1, "2 passed, 1 failed, 0 skipped"))

    def test_nothing_run_and_no_file(self):
        self.assertEqual(self.last_line()[0], 1)
        self.root = self.root / "absent.xml"
        status, text = self.run_check()
        self.root = self.root.parent
        self.assertEqual(status, 1)
        self.assertIn("absent.xml cannot be read", text)


if __name__ == "__main__":
    unittest.main()
