"""The pictures of the tour: sketches are current, all are small, have text of a readable size, and are shown by the tour."""
import re
import sys
import unittest
import xml.etree.ElementTree as xml
from pathlib import Path

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import make_pictures  # noqa: E402
import tour_sketches  # noqa: E402

FOLDER = ROOT / make_pictures.FOLDER


class TourPictures(unittest.TestCase):
    def test_sketches_are_those_of_the_tool(self):
        self.assertEqual(make_pictures.differences(FOLDER), [])

    def test_a_missing_picture_is_found(self):
        self.assertIn("leaves.svg", make_pictures.differences(FOLDER / "nowhere"))
        self.assertIn("atlas.png", make_pictures.differences(FOLDER / "nowhere"))

    def test_pictures_are_small_and_all_are_shown(self):
        tour = (ROOT / "docs" / "tour.md").read_text(encoding="utf-8")
        for path in FOLDER.iterdir():
            with self.subTest(picture=path.name):
                self.assertLess(path.stat().st_size, 150_000)
                self.assertIn(f"(pictures/tour/{path.name})", tour)

    def test_sketches_are_valid_and_their_text_is_readable(self):
        for name, sketch in tour_sketches.SKETCHES.items():
            with self.subTest(sketch=name):
                xml.fromstring(sketch())
                sizes = [float(size) for size in re.findall(r'font-size="([\d.]+)"', sketch())]
                self.assertGreaterEqual(min(sizes), 12)


if __name__ == "__main__":
    unittest.main()
