#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sums up ctest's JUnit file: what failed, what was skipped and why, and the line "N passed, N failed, N skipped".

usage: summarize_tests.py results.xml

A GoogleTest program is one ctest entry with many cases: each case is counted, read from the program's output, so
that a case that skips itself (no GPU, reference data absent) is seen and not taken for passed. Any other test
counts as one. An entry that ctest calls failed counts at least one failure, whatever its output says.
Exit status: 0 when nothing failed and something passed, else 1.
"""
import re
import sys
import xml.etree.ElementTree

CASE = re.compile(r"\[(       OK |  FAILED  |  SKIPPED )\] ([\w./]+)(?:, where .*)? \(\d+ ms\)$", re.M)
RAN = re.compile(r"^\[==========\] (\d+) tests? from \d+ test suites? ran\.", re.M)
NO_REASON = "no reason given"


def skip_reason(output, case):
    """What a GoogleTest case said when it skipped itself: the text after "file:line: Skipped"."""
    block = re.search(r"^\[ RUN      \] %s\n(.*?)^\[  SKIPPED \]" % re.escape(case), output, re.M | re.S)
    said = re.search(r": Skipped\n(.*)", block.group(1), re.S) if block else None
    return " ".join(said.group(1).split()) if said and said.group(1).strip() else NO_REASON


class Summary:
    def __init__(self):
        self.passed, self.failed, self.skipped = 0, [], []

    def add_googletest(self, name, output, entry_failed):
        states = CASE.findall(output)
        failures = [case for state, case in states if state.strip() == "FAILED"]
        self.passed += sum(state.strip() == "OK" for state, _ in states)
        self.failed += [f"{name}: {case}" for case in dict.fromkeys(failures)]
        self.skipped += [(f"{name}: {case}", skip_reason(output, case))
                         for state, case in states if state.strip() == "SKIPPED"]
        if entry_failed and not failures:
            running = [case for case in re.findall(r"^\[ RUN      \] ([\w./]+)$", output, re.M)
                       if case not in {case for _, case in states}]
            self.failed.append(f"{name}: " + (f"ended inside {running[-1]}" if running else "ended with an error"))

    def add_entry(self, case):
        name, status = case.get("name"), case.get("status")
        output = case.findtext("system-out") or ""
        failure, skip = case.find("failure"), case.find("skipped")
        failed = status == "fail" or failure is not None
        if CASE.search(output) or RAN.search(output):
            self.add_googletest(name, output, failed)
        elif failed:
            why = (failure.get("message") if failure is not None else "") or ""
            self.failed.append(f"{name}: {why}" if why else name)
        elif status in ("notrun", "disabled") or skip is not None:
            self.add_not_run(name, status, skip, output)
        else:
            self.passed += 1

    def add_not_run(self, name, status, skip, output):
        """A test that said so (exit 77) is skipped; one that could not be started is a failure."""
        message = (skip.get("message") if skip is not None else "") or ""
        if status == "disabled":
            self.skipped.append((name, "disabled in its CMakeLists.txt"))
        elif message.startswith("SKIP_"):
            said = [line.strip() for line in output.splitlines() if line.strip()]
            marked = [line for line in said if re.match(r"(?i)skip", line)]
            self.skipped.append((name, (marked or said or [NO_REASON])[-1]))
        else:
            self.failed.append(f"{name}: not run ({message or 'ctest gives no reason'})")


def summarize(path):
    summary = Summary()
    for case in xml.etree.ElementTree.parse(path).getroot().iter("testcase"):
        summary.add_entry(case)
    return summary


def main(arguments):
    if len(arguments) != 1:
        print(__doc__, file=sys.stderr)
        return 2
    try:
        summary = summarize(arguments[0])
    except (OSError, xml.etree.ElementTree.ParseError) as error:
        print(f"summarize_tests.py: {arguments[0]} cannot be read as a JUnit file: {error}", file=sys.stderr)
        return 1
    if summary.skipped:
        print("skipped:")
        by_reason = {}
        for name, reason in summary.skipped:
            by_reason.setdefault(reason, []).append(name)
        for reason, names in by_reason.items():
            print(f"  {reason}")
            for name in names:
                print(f"    {name}")
    if summary.failed:
        print("failed:")
        for name in summary.failed:
            print(f"  {name}")
    print(f"{summary.passed} passed, {len(summary.failed)} failed, {len(summary.skipped)} skipped")
    return 0 if summary.passed and not summary.failed else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
