#!/usr/bin/env python3
"""Counts test cases after ctest: those inside GoogleTest programs and Node's test runner, and one for each other entry.

Usage: count_tests.py FOLDER, where FOLDER holds ctest.xml (ctest --output-junit) and cases/test_<suite>.xml
(GTEST_OUTPUT=xml:). Prints the failed cases and the reasons for skipped ones; the last line is "N passed, N failed, N skipped".
Exit code 1 when a case failed or no case ran.
"""
import re
import sys
import xml.etree.ElementTree as xml
from collections import Counter
from pathlib import Path


class Counts:
    """Sums over all suites; `failed_names` in order of occurrence, `skip_reasons` with their counts."""

    def __init__(self):
        self.passed = self.failed = self.skipped = 0
        self.failed_names = []
        self.skip_reasons = Counter()

    def fail(self, name, times=1):
        self.failed += times
        self.failed_names.append(name)

    def skip(self, reason, times=1):
        self.skipped += times
        self.skip_reasons[reason] += times


def count_gtest(report, counts):
    """Adds the cases of one GoogleTest XML report. Returns the number of failures."""
    failed = 0
    for case in report.iter("testcase"):
        skipped = case.find("skipped")
        if case.find("failure") is not None:
            counts.fail(f'{case.get("classname")}.{case.get("name")}')
            failed += 1
        elif skipped is not None:
            counts.skip((skipped.get("message") or "no reason given").strip().splitlines()[-1].strip())
        elif case.get("status") == "notrun":
            counts.skip("disabled")
        else:
            counts.passed += 1
    return failed


def count_entry(entry, cases, counts):
    """Adds one ctest entry, from its most detailed report."""
    name, status = entry.get("name"), entry.get("status")
    output = entry.findtext("system-out") or ""
    report = cases / f"test_{name}.xml"
    node = {key: int(n) for key, n in re.findall(r"^(?:#|\u2139) (pass|fail|skipped) (\d+)\s*$", output, re.MULTILINE)}
    if report.exists():
        failed = count_gtest(xml.parse(report).getroot(), counts)
        if status == "fail" and not failed:
            counts.fail(f"{name}: the program failed after its last case")
    elif status == "notrun" or entry.find("skipped") is not None:
        counts.skip(f"{name}: " + (output.strip().splitlines() or ["not run"])[-1])
    elif status == "disabled":
        counts.skip(f"{name}: disabled")
    elif "pass" in node:
        counts.passed += node["pass"]
        if node.get("skipped"):
            counts.skip(f"{name}: see its output", node["skipped"])
        if node.get("fail") or status == "fail":
            counts.fail(name, max(1, node.get("fail", 0)))
    elif status == "fail":
        counts.fail(name)
    else:
        counts.passed += 1


def main():
    folder = Path(sys.argv[1])
    counts = Counts()
    for entry in xml.parse(folder / "ctest.xml").getroot().iter("testcase"):
        count_entry(entry, folder / "cases", counts)
    print("\ntest results")
    for name in counts.failed_names:
        print(f"  failed: {name}")
    for reason, times in counts.skip_reasons.most_common(12):
        print(f"  {times} skipped: {reason.removeprefix('skipped: ')}")
    print(f"{counts.passed} passed, {counts.failed} failed, {counts.skipped} skipped")
    sys.exit(1 if counts.failed or not counts.passed else 0)


if __name__ == "__main__":
    main()
