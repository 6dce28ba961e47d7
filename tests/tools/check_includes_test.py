"""Checks that tools/check_includes.py reports each kind of missing standard header in a small tree."""
import unittest

from run_check import run_check

GOOD = {
    "fase/core/ids.hpp": "#include <cstdint>\nstd::uint32_t id();\n",
    "fase/core/part-inl.hpp": "std::vector<int> part();\n",
    "bench/rows.hpp": '#include <vector>\n\n#include "fase/core/ids.hpp"\nstd::vector<std::uint32_t> rows();\n',
}


def check(files):
    return run_check("check_includes.py", files)


class CheckIncludes(unittest.TestCase):
    def assert_error(self, text, expected):
        code, output = check(GOOD | {"fase/core/bad.hpp": text})
        self.assertEqual(code, 1, output)
        self.assertIn(expected, output)

    def assert_good(self, text):
        code, output = check(GOOD | {"fase/core/good.hpp": text})
        self.assertEqual(code, 0, output)

    def test_a_good_tree_passes(self):
        self.assertEqual(check(GOOD)[0], 0, check(GOOD)[1])

    def test_a_missing_header_is_reported_with_line_and_remedy(self):
        self.assert_error("#include <vector>\n\nstd::vector<int> f();\nstd::string g();\n",
                          "fase/core/bad.hpp:4: uses std::string: include <string>")

    def test_a_standard_header_does_not_stand_for_another(self):
        self.assert_error("#include <unordered_map>\nstd::pair<int, int> f();\n", "include <utility>")

    def test_one_of_several_headers_is_enough(self):
        self.assert_good("#include <cstring>\nstd::size_t f();\n")
        self.assert_error("std::size_t f();\n", "<cstddef> or")

    def test_headers_of_fase_pass_on_what_they_include(self):
        self.assert_good('#include "bench/rows.hpp"\nstd::vector<std::uint32_t> f();\n')

    def test_a_name_is_reported_once_a_file(self):
        output = check(GOOD | {"fase/core/bad.hpp": "std::string f();\nstd::string g();\n"})[1]
        self.assertEqual(output.count("std::string"), 1)

    def test_a_name_that_the_table_lacks_is_reported(self):
        self.assert_error("std::brand_new f();\n", "add it to the table")

    def test_macros_and_operators_need_their_headers_too(self):
        self.assert_error("void f() { assert(true); }\n", "uses assert: include <cassert>")
        self.assert_error("auto operator<=>(A, A) = default;\n", "include <compare>")
        self.assert_error("void f(void* at) { new (at) int; }\n", "include <new>")
        self.assert_good("static_assert(true);\n")

    def test_comments_and_literals_are_not_code(self):
        self.assert_good("// std::map\n/* std::set */\nconst char* text = \"std::list \\\" std::any\";\nconst int n = 1'000;\n")


if __name__ == "__main__":
    unittest.main()
