"""Plants one offence of each kind in a small tree and sees that tools/check_layers.py names it."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

CHECK = Path(__file__).parents[2] / "tools" / "check_layers.py"
GOOD = {
    "fase/core/ids.hpp": "#include <cstdint>\n",
    "fase/math/vec3.hpp": '#include "fase/core/ids.hpp"\n',
    "fase/broad/grid.hpp": '#include "fase/math/vec3.hpp"\n',
    "fase/narrow/detail/gjk.hpp": '#include "fase/math/vec3.hpp"\n',
    "cli/main.cpp": '#include "fase/narrow/detail/gjk.hpp"\n#include "fase/broad/grid.hpp"\n',
}


def check(files):
    """Exit code and output of the check on a tree of these files."""
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            path = Path(folder) / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        done = subprocess.run([sys.executable, CHECK, folder], capture_output=True, text=True)
        return done.returncode, done.stdout


class CheckLayers(unittest.TestCase):
    def offends(self, extra, expected):
        code, output = check(GOOD | extra)
        self.assertEqual(code, 1, output)
        self.assertIn(expected, output)

    def test_a_good_tree_passes(self):
        self.assertEqual(check(GOOD)[0], 0, check(GOOD)[1])

    def test_an_include_that_points_up_is_named_with_its_line(self):
        self.offends({"fase/math/bad.hpp": '\n#include "fase/broad/grid.hpp"\n'}, "fase/math/bad.hpp:2: includes")

    def test_broad_and_narrow_do_not_know_each_other(self):
        self.offends({"fase/narrow/bad.cpp": '#include "fase/broad/grid.hpp"\n'}, "narrow may include only")

    def test_the_library_does_not_include_a_program(self):
        self.offends({"fase/core/bad.cpp": '#include "cli/main.cpp"\n'}, "may not include a program")

    def test_an_include_from_the_same_folder_without_its_path_is_refused(self):
        self.offends({"fase/core/bad.hpp": '#include "ids.hpp"\n'}, "repository's root")

    def test_a_missing_file_is_named(self):
        self.offends({"fase/core/bad.hpp": '#include "fase/core/nowhere.hpp"\n'}, "names no file")

    def test_a_folder_outside_the_drawing_is_refused(self):
        self.offends({"fase/utils/all.hpp": ""}, "no layer of the drawing")

    def test_a_circle_is_shown(self):
        circle = {
            "fase/core/a.hpp": '#include "fase/core/b.hpp"\n',
            "fase/core/b.hpp": '#include "fase/core/a.hpp"\n',
        }
        self.offends(circle, "fase/core/a.hpp -> fase/core/b.hpp -> fase/core/a.hpp")


if __name__ == "__main__":
    unittest.main()
