"""Runs tools/count_tests.py on each kind of result and checks its last line."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

COUNT = Path(__file__).parents[2] / "tools" / "count_tests.py"


def case(name, inside=""):
    return f'<testcase name="{name}" status="run" classname="math">{inside}</testcase>'


def count(entries, reports=None):
    """Returns exit code and output for ctest entries (name, status, output) and GoogleTest reports (suite: cases)."""
    with tempfile.TemporaryDirectory() as folder:
        lines = [f'<testcase name="{n}" status="{s}"><system-out>{o}</system-out></testcase>' for n, s, o in entries]
        (Path(folder) / "ctest.xml").write_text("<testsuite>" + "".join(lines) + "</testsuite>")
        (Path(folder) / "cases").mkdir()
        for suite, cases in (reports or {}).items():
            report = "<testsuites><testsuite>" + "".join(cases) + "</testsuite></testsuites>"
            (Path(folder) / "cases" / f"test_{suite}.xml").write_text(report)
        done = subprocess.run([sys.executable, COUNT, folder], capture_output=True, text=True)
        return done.returncode, done.stdout


class CountTests(unittest.TestCase):
    def test_cases_inside_a_program_are_counted(self):
        cases = [case("a"), case("b"), case("c", '<skipped message="x.cpp:1&#x0A;skipped: no data"/>')]
        code, output = count([("math", "run", ""), ("layers", "run", "")], {"math": cases})
        self.assertEqual((code, output.splitlines()[-1]), (0, "3 passed, 0 failed, 1 skipped"))
        self.assertIn("1 skipped: no data", output)

    def test_a_failed_case_is_listed_and_gives_exit_code_1(self):
        code, output = count([("math", "fail", "")], {"math": [case("a"), case("b", '<failure message="x"/>')]})
        self.assertEqual((code, output.splitlines()[-1]), (1, "1 passed, 1 failed, 0 skipped"))
        self.assertIn("failed: math.b", output)

    def test_a_program_that_crashes_counts_as_one_failure(self):
        self.assertIn("0 passed, 1 failed", count([("math", "fail", "")])[1])

    def test_a_program_that_fails_after_its_last_case_counts_as_a_failure(self):
        self.assertIn("1 passed, 1 failed", count([("math", "fail", "")], {"math": [case("a")]})[1])

    def test_the_counts_of_nodes_test_runner_are_read(self):
        output = count([("viewer", "fail", "# pass 7\n# fail 2\n# skipped 1\n")])[1]
        self.assertEqual(output.splitlines()[-1], "7 passed, 2 failed, 1 skipped")

    def test_an_empty_run_is_a_failure(self):
        self.assertEqual(count([])[0], 1)


if __name__ == "__main__":
    unittest.main()
