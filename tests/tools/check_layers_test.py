"""Checks that tools/check_layers.py reports each kind of violation in a small tree."""
import unittest

from run_check import run_check

GOOD = {
    "fase/core/ids.hpp": "#include <cstdint>\n",
    "fase/math/vec3.hpp": '#include "fase/core/ids.hpp"\n',
    "fase/broad/grid.hpp": '#include "fase/math/vec3.hpp"\n',
    "fase/narrow/detail/gjk.hpp": '#include "fase/math/vec3.hpp"\n',
    "cli/main.cpp": '#include "fase/narrow/detail/gjk.hpp"\n#include "fase/broad/grid.hpp"\n',
}


def check(files):
    return run_check("check_layers.py", files)


class CheckLayers(unittest.TestCase):
    def assert_error(self, extra, expected):
        code, output = check(GOOD | extra)
        self.assertEqual(code, 1, output)
        self.assertIn(expected, output)

    def test_a_good_tree_passes(self):
        self.assertEqual(check(GOOD)[0], 0, check(GOOD)[1])

    def test_an_upward_include_is_reported_with_its_line(self):
        self.assert_error({"fase/math/bad.hpp": '\n#include "fase/broad/grid.hpp"\n'}, "fase/math/bad.hpp:2: includes")

    def test_broad_and_narrow_do_not_know_each_other(self):
        self.assert_error({"fase/narrow/bad.cpp": '#include "fase/broad/grid.hpp"\n'}, "narrow may include only")

    def test_a_room_includes_only_the_rooms_below_it(self):
        below = {"fase/broad/boxes/store.hpp": "", "fase/broad/row_grid/set.hpp": '#include "fase/broad/boxes/store.hpp"\n'}
        self.assertEqual(check(GOOD | below)[0], 0)
        above = {"fase/broad/row_grid/set.hpp": "", "fase/broad/boxes/bad.hpp": '#include "fase/broad/row_grid/set.hpp"\n'}
        self.assert_error(above, "broad/boxes may include of its layer's rooms only itself")

    def test_a_room_is_internal_to_its_layer(self):
        room = {"fase/broad/sweep/axis.hpp": "", "fase/query/bad.hpp": '#include "fase/broad/sweep/axis.hpp"\n'}
        self.assert_error(room, "broad/sweep is internal to broad")
        self.assert_error({"fase/broad/sweep/axis.hpp": "", "examples/bad.cpp": '#include "fase/broad/sweep/axis.hpp"\n'},
                     "examples include public headers only")

    def test_headers_for_users_are_not_included_by_the_library(self):
        self.assert_error({"fase/world.hpp": "", "fase/core/bad.hpp": '#include "fase/world.hpp"\n'}, "is for users")

    def test_the_library_does_not_include_a_program(self):
        self.assert_error({"fase/core/bad.cpp": '#include "cli/main.cpp"\n'}, "may not include a program")

    def test_an_include_from_the_same_folder_without_its_path_is_refused(self):
        self.assert_error({"fase/core/bad.hpp": '#include "ids.hpp"\n'}, "repository's root")

    def test_a_missing_file_is_reported(self):
        self.assert_error({"fase/core/bad.hpp": '#include "fase/core/nowhere.hpp"\n'}, "names no file")

    def test_a_folder_without_a_layer_is_refused(self):
        self.assert_error({"fase/utils/all.hpp": ""}, "no layer of the drawing")

    def test_a_cycle_is_reported(self):
        cycle = {
            "fase/core/a.hpp": '#include "fase/core/b.hpp"\n',
            "fase/core/b.hpp": '#include "fase/core/a.hpp"\n',
        }
        self.assert_error(cycle, "fase/core/a.hpp -> fase/core/b.hpp -> fase/core/a.hpp")


if __name__ == "__main__":
    unittest.main()
