"""README.md: its first example is the file that the tests build and run; links in the docs lead to files."""
import importlib.util
import re
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).parents[2]
spec = importlib.util.spec_from_file_location("check_links", ROOT / "tools" / "check_links.py")
check_links = importlib.util.module_from_spec(spec)
spec.loader.exec_module(check_links)


class Readme(unittest.TestCase):
    def test_the_example_equals_the_file_that_is_built(self):
        shown = re.search(r"```cpp\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL)[1]
        self.assertEqual(shown, (ROOT / "examples" / "01_falling_box.cpp").read_text())

    def test_links_lead_to_files(self):
        for page in [*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md")]:
            with self.subTest(page=page.name):
                self.assertEqual(check_links.dead_links(page), [])

    def test_a_dead_link_is_found_outside_of_code_only(self):
        with tempfile.TemporaryDirectory() as folder:
            page = Path(folder) / "page.md"
            page.write_text("# A `part`, 1\n[a](page.md) [b](page.md#a-part-1) [c](gone.md#part) [d](https://x.org) [e](#2)\n"
                            "```\n# 2\n[](lambda) {}\n```\n")
            self.assertEqual(check_links.dead_links(page), ["gone.md#part", "#2"])


if __name__ == "__main__":
    unittest.main()
