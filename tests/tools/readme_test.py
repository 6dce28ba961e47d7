"""README.md: its first example is the file that the tests build and run; links in the docs lead to files."""
import re
import unittest
from pathlib import Path

ROOT = Path(__file__).parents[2]


class Readme(unittest.TestCase):
    def test_the_example_equals_the_file_that_is_built(self):
        shown = re.search(r"```cpp\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL)[1]
        self.assertEqual(shown, (ROOT / "examples" / "01_falling_box.cpp").read_text())

    def test_links_lead_to_files(self):
        for page in [*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md")]:
            text = re.sub(r"^```.*?^```", "", page.read_text(), flags=re.DOTALL | re.MULTILINE)  # lambdas in code look like links
            for target in re.findall(r"\]\(([^)#:]+)\)", text):
                with self.subTest(page=page.name, target=target):
                    self.assertTrue((page.parent / target).exists(), f"{page.name} points to {target}")


if __name__ == "__main__":
    unittest.main()
