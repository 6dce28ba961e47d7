"""The check of the tour sees code that is not an example's, and output that is not a program's."""
import importlib.util
import tempfile
import unittest
from pathlib import Path

spec = importlib.util.spec_from_file_location("check_tour", Path(__file__).parents[2] / "tools" / "check_tour.py")
tour = importlib.util.module_from_spec(spec)
spec.loader.exec_module(tour)

SOURCES = {"02_a": "int main() {\n    if (true) {\n        go();\n        stay();\n    }\n}\n", "03_b": "b();\n"}
OUTPUTS = {"02_a": "went\nstayed\n", "03_b": "b\n"}


def errors(page):
    return tour.check(page, SOURCES.get, OUTPUTS.get)[0]


class CheckTour(unittest.TestCase):
    def test_accepts_part_of_an_example_with_less_indentation(self):
        self.assertEqual(errors("`examples/02_a.cpp`:\n```cpp\nif (true) {\n    go();\n```\n"), [])

    def test_finds_missing_changed_and_reordered_lines(self):
        for code in ["if (true) {\n    stay();\n", "go( );\n", "go()\n", "stay();\ngo();\n"]:
            with self.subTest(code=code):
                self.assertEqual(len(errors(f"examples/02_a.cpp\n```cpp\n{code}```\n")), 1)

    def test_compares_with_the_example_named_last(self):
        page = "examples/02_a.cpp\nexamples/03_b.cpp\n```cpp\n{}\n```\n"
        self.assertEqual(errors(page.format("b();")), [])
        self.assertEqual(len(errors(page.format("go();"))), 1)
        self.assertEqual(len(errors("```cpp\nb();\n```\n")), 1)

    def test_finds_wrong_output_and_can_update_it(self):
        page = "examples/02_a.cpp\n```text\nwent\n```\nand\n"
        found, updated = tour.check(page, SOURCES.get, OUTPUTS.get)
        self.assertEqual(len(found), 1)
        self.assertEqual(updated, "examples/02_a.cpp\n```text\nwent\nstayed\n```\nand\n")
        self.assertEqual(errors(updated), [])

    def test_runs_commands_and_compares_their_output(self):
        page = "```console\n$ go\nwent in … ms\n$ stay\n```\n"
        run = {"go": "went in 3 ms\n", "stay": ""}
        self.assertEqual(tour.check(page, None, None, run.get)[0], [])
        self.assertEqual(tour.check(page, None, None)[0], [])
        for output in [{"go": "went in 3 s\n"}, {"go": "went in 3 ms\nand back\n"}, {"stay": "no\nexit code 1\n"}]:
            with self.subTest(output=output):
                self.assertEqual(len(tour.check(page, None, None, (run | output).get)[0]), 1)

    def test_tells_the_exit_code_of_a_command_that_fails(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(tour.output_of_command("echo a; exit 3", folder, folder), "a\nexit code 3\n")


if __name__ == "__main__":
    unittest.main()
