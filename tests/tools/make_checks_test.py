"""The page of checks: it agrees with the stored figures, names every suite, and shows limits as they are."""
import json
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import make_checks  # noqa: E402


def row(case, limit, measured=1.0, ok=True):
    return {"suite": "stacks", "case": case, "unit": "m", "expected": 0, "measured": measured, "limit": limit, "ok": ok, "note": None}


class Checks(unittest.TestCase):
    def test_the_page_agrees_with_the_figures(self):
        self.assertEqual(make_checks.main(["--check", str(ROOT)]), 0)

    def test_every_suite_of_the_figures_is_described(self):
        rows = json.loads((ROOT / make_checks.FIGURES).read_text(encoding="utf-8"))
        self.assertEqual({row["suite"] for row in rows}, set(make_checks.SUITES))

    def test_limits_read_as_they_are(self):
        cases = {None: "–", 0: "0", 0.01: "≤ 0.01", (1, 1): "1", (2.97, 3.03): "2.97 … 3.03", (0.7, None): "≥ 0.7", (None, 1): "≤ 1"}
        for limit, text in cases.items():
            with self.subTest(limit=limit):
                self.assertEqual(make_checks.limit_of(list(limit) if isinstance(limit, tuple) else limit), text)

    def test_failures_are_shown_and_listed(self):
        rows = [row("a/sinks", 0.5), row("a/drift", 0.5, 2.0, False), row("b/sinks", 1, None, False)]
        page = make_checks.page_of(rows)
        self.assertIn("| `a` | sinks | 0 | 1 | ≤ 0.5 | m | ok |\n|  | drift | 0 | 2 | ≤ 0.5 | m | **FAILED** |", page)
        self.assertIn("| `b` | sinks | 0 | – | ≤ 1 | m | **FAILED** |", page)
        self.assertIn("1 of 3", page)
        self.assertTrue(make_checks.known_of(rows).endswith("\nstacks/a/drift\nstacks/b/sinks\n"))

    def test_a_changed_page_fails_the_check(self):
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            (root / "bench/results").mkdir(parents=True)
            (root / make_checks.FIGURES).write_text(json.dumps([row("a/sinks", 0.5)]), encoding="utf-8")
            self.assertEqual(make_checks.main([folder]), 0)
            self.assertEqual(make_checks.main(["--check", folder]), 0)
            page = root / make_checks.PAGE
            page.write_text(page.read_text(encoding="utf-8") + "more", encoding="utf-8")
            self.assertEqual(make_checks.main(["--check", folder]), 1)


if __name__ == "__main__":
    unittest.main()
