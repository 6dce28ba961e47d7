#!/usr/bin/env python3
"""Fails when a header uses a name of the C++ standard library without that name's header.

Usage: check_includes.py [REPOSITORY]. Prints file:line of each offence. A header may rely on what it includes itself and on what
Fase's headers that it includes do, but not on what a standard header happens to include: that differs between libraries, and the
target header_check, which compiles every header alone, precompiles the standard ones. A name that the table lacks is an offence,
too, so that the table stays complete.
"""
import re
import sys
from pathlib import Path

# A standard header and names that it declares. A name in several rows needs one of them.
DECLARES = {
    "algorithm": """binary_search clamp copy copy_if copy_n count count_if equal equal_range fill fill_n find find_if for_each generate
        includes is_sorted lexicographical_compare lower_bound max max_element merge min min_element minmax mismatch move nth_element
        partial_sort partition pop_heap push_heap ranges remove remove_if replace reverse rotate search set_difference
        set_intersection set_union sort sort_heap stable_partition stable_sort swap_ranges transform unique upper_bound all_of
        any_of none_of make_heap adjacent_find""",
    "any": "any any_cast",
    "array": "array begin data end get size to_array tuple_element tuple_size tuple_size_v",
    "atomic": """atomic atomic_ref memory_order memory_order_acq_rel memory_order_acquire memory_order_relaxed
        memory_order_release memory_order_seq_cst""",
    "bit": "bit_cast bit_ceil bit_floor bit_width countl_one countl_zero countr_one countr_zero endian has_single_bit popcount rotl rotr",
    "charconv": "chars_format from_chars from_chars_result to_chars to_chars_result",
    "chrono": "chrono micro milli nano",
    "cmath": """abs acos asin atan atan2 cbrt ceil copysign cos exp exp2 fabs floor fma fmax fmin fmod frexp hypot isfinite isinf isnan
        ldexp llround log log10 log2 lround nearbyint nextafter pow remainder rint round signbit sin sqrt tan trunc""",
    "compare": "partial_ordering strong_ordering weak_ordering",
    "concepts": """assignable_from common_with constructible_from convertible_to copy_constructible copyable default_initializable
        derived_from destructible equality_comparable floating_point integral invocable movable move_constructible predicate
        regular regular_invocable relation same_as semiregular signed_integral swappable totally_ordered unsigned_integral""",
    "condition_variable": "condition_variable",
    "cstddef": "byte max_align_t nullptr_t ptrdiff_t size_t to_integer",
    "cstdint": """int16_t int32_t int64_t int8_t intptr_t uint16_t uint32_t uint64_t uint8_t uintptr_t""",
    "cstdio": "FILE fclose fopen fputs fread fwrite printf size_t snprintf",
    "cstdlib": "abort abs exit free getenv malloc size_t strtod",
    "cstring": "memchr memcmp memcpy memmove memset size_t strcmp strlen",
    "ctime": "clock clock_t size_t time time_t",
    "deque": "begin data deque empty end erase erase_if size",
    "exception": "current_exception exception exception_ptr rethrow_exception terminate uncaught_exceptions",
    "filesystem": "filesystem",
    "fstream": "fstream ifstream ofstream",
    "functional": "bind_front equal_to function greater hash identity invoke less less_equal not_equal_to plus reference_wrapper",
    "initializer_list": "initializer_list",
    "iterator": """back_inserter begin data distance empty end forward_iterator input_iterator iterator_traits next prev
        random_access_iterator reverse_iterator size ssize""",
    "limits": "numeric_limits",
    "list": "begin empty end erase erase_if list size",
    "map": "begin empty end erase_if map multimap size",
    "memory": """addressof allocator allocator_traits assume_aligned construct_at default_delete destroy_at destroy_n make_shared
        make_unique make_unique_for_overwrite shared_ptr uninitialized_copy_n unique_ptr weak_ptr""",
    "mutex": "call_once lock_guard mutex once_flag scoped_lock unique_lock",
    "new": "align_val_t bad_alloc launder nothrow",
    "numbers": "numbers",
    "numeric": "accumulate exclusive_scan gcd inclusive_scan inner_product iota lcm midpoint partial_sum reduce",
    "optional": "make_optional nullopt nullopt_t optional",
    "ranges": "ranges views",
    "set": "begin empty end erase_if multiset set size",
    "span": "as_bytes as_writable_bytes begin data dynamic_extent empty end size span",
    "stdexcept": "invalid_argument length_error logic_error out_of_range runtime_error",
    "string": "begin char_traits data empty end erase erase_if getline size stod stoi string to_string",
    "string_view": "begin data empty end size string_view",
    "thread": "jthread this_thread thread",
    "tuple": "apply forward_as_tuple get ignore make_tuple tie tuple tuple_element tuple_size tuple_size_v",
    "type_traits": """add_const_t bool_constant common_type_t conditional conditional_t decay_t enable_if_t extent_v false_type
        has_unique_object_representations_v integral_constant invoke_result_t is_aggregate_v is_arithmetic_v is_base_of_v is_const_v
        is_constant_evaluated is_constructible_v is_convertible_v is_default_constructible_v is_empty_v is_enum_v is_floating_point_v
        is_function_v is_integral_v is_invocable_r_v is_invocable_v is_nothrow_move_constructible_v is_pointer_v is_reference_v
        is_same is_same_v is_signed_v is_standard_layout_v is_trivial_v is_trivially_copyable_v is_trivially_destructible_v
        is_unsigned_v is_void_v make_signed_t make_unsigned_t remove_const_t remove_cv_t remove_cvref_t remove_pointer_t
        remove_reference_t true_type type_identity type_identity_t underlying_type_t void_t""",
    "unordered_map": "begin empty end erase_if size unordered_map unordered_multimap",
    "unordered_set": "begin empty end erase_if size unordered_set",
    "utility": """as_const cmp_less declval exchange forward get in_place in_place_index in_place_type index_sequence
        index_sequence_for integer_sequence make_index_sequence make_pair move pair swap tuple_element tuple_size tuple_size_v""",
    "variant": "get get_if holds_alternative in_place_index monostate variant variant_alternative_t variant_size variant_size_v visit",
    "vector": "begin data empty end erase erase_if size vector",
}
HEADERS_OF = {}
for header, names in DECLARES.items():
    for name in names.split():
        HEADERS_OF.setdefault(name, set()).add(header)
# What is written without `std::`, and its headers.
BARE = {
    r"(?<!_)assert\s*\(": {"cassert"},
    r"\boffsetof\s*\(": {"cstddef"},
    r"<=>": {"compare"},
    r"\btypeid\s*\(": {"typeinfo"},
    r"(?<!operator )\bnew\s*\((?!std::nothrow)": {"new"},
    r"\bU?INT(?:8|16|32|64|PTR)_(?:MAX|MIN)\b|\bSIZE_MAX\b": {"cstdint"},
    r"\bU?(?:INT|CHAR|SHRT|LONG)_(?:MAX|MIN)\b|\bCHAR_BIT\b": {"climits"},
    r"\b(?:FLT|DBL)_[A-Z_]+\b": {"cfloat"},
}
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(["<])([^">]+)[">]', re.MULTILINE)
NOT_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|R"\((?:.*?)\)"|"(?:\\.|[^"\\\n])*"|(?<![0-9a-fA-F])\'(?:\\.|[^\'\\\n])+\'', re.DOTALL)
QUALIFIED = re.compile(r"\bstd::(\w+)")


def code_of(text):
    """The text without includes, comments and literals, which become as many line ends as they hold."""
    blank = lambda found: "\n" * found[0].count("\n")
    return NOT_CODE.sub(blank, INCLUDE.sub(blank, text))


class Tree:
    def __init__(self, root):
        self.root = root
        self.reached = {}

    def text(self, path):
        file = self.root / path
        return file.read_text(encoding="utf-8") if file.is_file() else ""  # absent: generated by CMake

    def system_headers(self, path):
        """The headers in angle brackets that a file includes, itself or through Fase's headers."""
        if path not in self.reached:
            self.reached[path] = set()  # ends circles, which check_layers.py reports
            for quote, name in INCLUDE.findall(self.text(path)):
                self.reached[path] |= {name} if quote == "<" else self.system_headers(name)
        return self.reached[path]

    def offences(self, path):
        included = self.system_headers(path)
        code = code_of(self.text(path))
        uses = [(found.start(), found[0], HEADERS_OF.get(found[1], set())) for found in QUALIFIED.finditer(code)]
        for pattern, headers in BARE.items():
            uses += [(found.start(), found[0].strip("( "), headers) for found in re.finditer(pattern, code)]
        told = set()
        for at, name, headers in sorted(uses, key=lambda use: use[0]):
            if name in told or headers & included:
                continue
            told.add(name)
            expected = " or ".join(f"<{header}>" for header in sorted(headers))
            line = code.count("\n", 0, at) + 1
            yield f"{path}:{line}: uses {name}: " + (f"include {expected}" if headers else "add it to the table in tools/check_includes.py")


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent.parent).resolve()
    tree = Tree(root)
    files = [file.relative_to(root).as_posix() for top in ("fase", "bench", "cli") for file in sorted((root / top).rglob("*.hpp"))
             if not file.name.endswith("-inl.hpp")]  # parts of sources, which include for them
    offences = [offence for path in files for offence in tree.offences(path)]
    print("\n".join(offences) or f"{len(files)} headers include what they use of the standard library")
    sys.exit(1 if offences else 0)


if __name__ == "__main__":
    main()
