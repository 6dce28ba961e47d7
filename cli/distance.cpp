/// The command `fase distance`: compares signed distances of pairs of shapes with published values.
#include "cli/distance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <type_traits>
#include <vector>

#include "cli/common/arguments.hpp"
#include "cli/common/command_registry.hpp"
#include "cli/common/input.hpp"
#include "cli/common/output.hpp"
#include "fase/core/detail/files.hpp"
#include "fase/core/detail/text.hpp"
#include "fase/narrow/distance.hpp"
#include "fase/scene/detail/json.hpp"

namespace fase::cli {
namespace {

using scene::JsonKind;
using scene::JsonValue;

constexpr std::size_t max_bytes = std::size_t{1} << 28;
/// Tolerance for reference numbers from other code that state none; sizes are float.
constexpr double computed_tolerance = 1e-6;

/// A shape and its pose in the world. No shape: Fase has no such type.
struct Placed {
    std::optional<Shape> shape;
    TransformD pose;
    std::string type;
};

struct Verdict {
    std::string id;
    std::optional<double> distance, published, error;
    bool within = false;
    std::string skipped;  ///< the reason; empty: the case was checked
};

Error bad(const JsonValue& at, std::string problem) {
    return {
        Status::Format, fmt::format("{}: {}", detail::byte_text(at.offset()), at.pointer()), std::move(problem), {}};
}

/// The member `key` as a number; nullopt if it is missing or null.
Result<std::optional<double>> number_in(const JsonValue& object, std::string_view key) {
    const std::optional<JsonValue> value = object.find(key);
    if (!value || value->is(JsonKind::Null)) return std::optional<double>{};
    if (!value->is(JsonKind::Number))
        return bad(*value, fmt::format("found {}; expected a number", name_of(value->kind())));
    return std::optional<double>{value->number()};
}

/// The member `key` as an array of `count` numbers.
Result<std::array<double, 9>> numbers_in(const JsonValue& object, std::string_view key, std::size_t count) {
    const std::optional<JsonValue> value = object.find(key);
    if (!value) return bad(object, fmt::format("found no \"{}\"; expected {} numbers", key, count));
    std::array<double, 9> numbers{};
    std::size_t found = 0;
    bool all_numbers = value->is(JsonKind::Array);
    value->for_each_element([&](const JsonValue& element) {
        if (!element.is(JsonKind::Number)) {
            all_numbers = false;
        } else if (found < count) {
            numbers[found] = element.number();
        }
        ++found;
    });
    if (!all_numbers || found != count) return bad(*value, fmt::format("found no array of {} numbers", count));
    return numbers;
}

/// Calls use.operator()<S>() for the shape of that name, if it has sizes; the file can describe no other shape.
template <class F> void with_sized_shape(std::string_view name, const F& use) {
    for_each_shape([&]<class S>() {
        if constexpr (SizedShape<S>) {
            if (S::name == name && !S::sizes.empty()) use.template operator()<S>();
        }
    });
}

Result<Placed> read_shape(const JsonValue& object) {
    const std::optional<JsonValue> type = object.find("type");
    if (!type || !type->is(JsonKind::String)) return bad(object, "found no shape; expected an object with a \"type\"");
    Placed placed;
    placed.type = type->string();
    std::size_t count = 0;
    with_sized_shape(placed.type, [&]<class S>() { count = S::sizes.size(); });
    if (count == 0) return placed;

    const auto size = numbers_in(object, "size", count);
    if (!size) return size.error();
    const auto position = numbers_in(object, "pos", 3);
    if (!position) return position.error();
    const auto rows = numbers_in(object, "rot", 9);
    if (!rows) return rows.error();
    std::array<float, 9> s{};
    for (std::size_t i = 0; i < count; ++i) {
        s[i] = static_cast<float>((*size)[i]);
        if (!(s[i] > 0 && std::isfinite(s[i]))) {
            return bad(*object.find("size"), fmt::format("found {}; expected a size above 0", (*size)[i]));
        }
    }
    const auto& r = *rows;
    placed.pose.position = {(*position)[0], (*position)[1], (*position)[2]};
    Mat3d& m = placed.pose.rotation;
    m = {{r[0], r[3], r[6]}, {r[1], r[4], r[7]}, {r[2], r[5], r[8]}};
    const Mat3d off = transpose(m) * m - Mat3d::identity();
    constexpr double orthonormal = 1e-6;
    const double worst = std::sqrt(length_squared(off.x) + length_squared(off.y) + length_squared(off.z));
    if (!(worst < orthonormal && determinant(m) > 0)) return bad(*object.find("rot"), "found no rotation matrix");

    with_sized_shape(placed.type, [&]<class S>() {
        SizeNumbers<S> sizes;
        std::copy_n(s.begin(), sizes.size(), sizes.begin());
        placed.shape = shape_with<S>(sizes);
        // Round shapes have their axis along z in the file, along y here.
        constexpr bool has_axis = !std::is_same_v<S, Box> && !std::is_same_v<S, Sphere>;
        if (has_axis) m = m * Mat3d{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
    });
    return placed;
}

Result<Verdict> check_case(const JsonValue& object) {
    if (!object.is(JsonKind::Object))
        return bad(object, fmt::format("found {}; expected an object", name_of(object.kind())));
    Verdict verdict;
    const std::optional<JsonValue> id = object.find("id");
    if (!id || !id->is(JsonKind::String)) return bad(object, "found no \"id\"; expected a text");
    verdict.id = id->string();
    std::array<Placed, 2> placed;
    for (std::size_t i = 0; i < 2; ++i) {
        const char* key = i == 0 ? "a" : "b";
        const std::optional<JsonValue> shape = object.find(key);
        if (!shape) return bad(object, fmt::format("found no \"{}\"; expected a shape", key));
        Result<Placed> read = read_shape(*shape);
        if (!read) return read.error();
        placed[i] = *std::move(read);
    }
    const auto published = number_in(object, "distance"), tolerance = number_in(object, "tol");
    const auto sign = number_in(object, "sign"), computed = number_in(object, "distance_computed_by_us");
    for (const auto* number : {&published, &tolerance, &sign, &computed}) {
        if (!*number) return number->error();
    }
    if (*published && !*tolerance) return bad(object, "found a \"distance\" without \"tol\"; expected both");

    for (const Placed& p : placed) {
        if (!p.shape) verdict.skipped = fmt::format("Fase has no shape {}", scene::quoted_short(p.type));
    }
    if (!verdict.skipped.empty()) return verdict;
    const TransformD b_in_a = inverse(placed[0].pose) * placed[1].pose;
    const double distance = narrow::signed_distance(*placed[0].shape, *placed[1].shape, b_in_a).distance;
    verdict.distance = distance;
    if (!*published && !*sign && !*computed) {
        verdict.skipped = "no published number";
        return verdict;
    }
    verdict.within = true;
    if (*sign) verdict.within = **sign > 0 ? distance > 0 : **sign < 0 ? distance < 0 : distance == 0;
    const auto compare_with = [&](double number, double allowed) {
        verdict.published = number;
        verdict.error = std::abs(distance - number);
        if (!(*verdict.error <= allowed)) verdict.within = false;
    };
    if (*computed) compare_with(**computed, computed_tolerance);
    if (*published) compare_with(**published, **tolerance);
    return verdict;
}

Result<std::vector<Verdict>> check_file(const std::string& file) {
    static constexpr FileKind kinds[]{FileKind::Json};
    if (auto checked = check_input(file, {"distance", "pairs of shapes (.json)", kinds}); !checked)
        return checked.error();
    const auto bytes = read_file(file, max_bytes);
    if (!bytes) return bytes.error();
    const auto document = scene::parse_json({reinterpret_cast<const char*>(bytes->data()), bytes->size()});
    if (!document) return document.error();
    const std::optional<JsonValue> cases = document->root().find("cases");
    if (!cases || !cases->is(JsonKind::Array)) {
        return Error{Status::Format,
                     detail::byte_text(0),
                     "found no \"cases\"; expected an object with an array of that name",
                     {}};
    }
    std::vector<Verdict> verdicts;
    std::optional<Error> first_error;
    cases->for_each_element([&](const JsonValue& one) {
        if (first_error) return;
        Result<Verdict> verdict = check_case(one);
        if (verdict) {
            verdicts.push_back(*std::move(verdict));
        } else {
            first_error = verdict.error();
        }
    });
    if (first_error) return *first_error;
    if (verdicts.empty()) return bad(*cases, "found no case; expected at least one");
    return verdicts;
}

std::string json_of(const std::optional<double>& number) {
    return number && std::isfinite(*number) ? fmt::format("{}", *number) : "null";
}

struct Summary {
    std::size_t total = 0, within = 0, skipped = 0;
    double worst_error = 0;
};

void print_json(const std::vector<Verdict>& verdicts, const Summary& sum) {
    std::string text = fmt::format(R"({{"total": {}, "within": {}, "skipped": {}, "worst_error": {}, "cases": [)",
                                   sum.total, sum.within, sum.skipped, sum.worst_error);
    bool first = true;
    for (const Verdict& v : verdicts) {
        text += fmt::format(
            "{}\n {{\"id\": {}, \"distance\": {}, \"published\": {}, \"error\": {}, \"within\": {}, \"skipped\": {}}}",
            first ? "" : ",", scene::quoted(v.id), json_of(v.distance), json_of(v.published), json_of(v.error),
            v.skipped.empty() ? (v.within ? "true" : "false") : "null",
            v.skipped.empty() ? "null" : scene::quoted(v.skipped));
        first = false;
    }
    text += "\n]}\n";
    std::fwrite(text.data(), 1, text.size(), stdout);
}

void print_lines(const std::vector<Verdict>& verdicts, const Summary& sum) {
    std::string text;
    for (const Verdict& v : verdicts) {
        text += printable(v.id);
        if (v.distance) text += fmt::format("  distance {:.9g}", *v.distance);
        if (v.error) text += fmt::format("  published {:.9g}  error {:.2g}", *v.published, *v.error);
        if (!v.skipped.empty()) {
            text += fmt::format("  skipped: {}", printable(v.skipped));
        } else {
            text += v.within ? "  ok" : "  WRONG";
        }
        text += '\n';
    }
    text += fmt::format("{} of {} within tolerance ({} skipped, worst error {:.2g})\n", sum.within,
                        sum.total - sum.skipped, sum.skipped, sum.worst_error);
    std::fwrite(text.data(), 1, text.size(), stdout);
}

}  // namespace

int run_distance(const DistanceOptions& options) {
    const Result<std::vector<Verdict>> verdicts = check_file(options.file);
    if (!verdicts) {
        Error error = verdicts.error();
        const bool names_file = error.where.starts_with(options.file);
        if (!names_file) error.where = options.file + ": " + error.where;
        return refuse(error);
    }
    Summary sum;
    sum.total = verdicts->size();
    for (const Verdict& v : *verdicts) {
        if (!v.skipped.empty()) ++sum.skipped;
        if (v.skipped.empty() && v.within) ++sum.within;
        if (v.error && *v.error > sum.worst_error) sum.worst_error = *v.error;
    }
    if (options.json) {
        print_json(*verdicts, sum);
    } else {
        print_lines(*verdicts, sum);
    }
    return sum.within + sum.skipped == sum.total ? exit_ok : exit_check_failed;
}

void add_distance(Command& program, CommandRegistry& registry) {
    auto& distance = registry.options<DistanceOptions>();
    Command command = program.add_command("distance", "Compare distances of pairs of shapes with published values");
    command.add_text("PAIRS.json", "Pairs with their expected distances", distance.file).required();
    add_json(command, distance.json);
    command.set_footer(
        "\nExample:\n  fase distance pairs.json\n"
        "\nThe file, with the distance of two unit spheres whose centres are 3 m apart:\n"
        "  {\"cases\": [{\"id\": \"apart\",\n"
        "    \"a\": {\"type\": \"sphere\", \"size\": [1], \"pos\": [0, 0, 0], \"rot\": [1, 0, 0, 0, 1, 0, 0, 0, 1]},\n"
        "    \"b\": {\"type\": \"sphere\", \"size\": [1], \"pos\": [3, 0, 0], \"rot\": [1, 0, 0, 0, 1, 0, 0, 0, 1]},\n"
        "    \"distance\": 1, \"tol\": 1e-6}]}\n"
        "type and size: box, 3 half sizes; sphere, radius; capsule and cylinder, radius and half length along local "
        "z.\n"
        "pos in metres; rot: a rotation matrix by rows, local to world. Expected, each optional: distance with tol\n"
        "(negative: penetration), sign of the distance (-1, 0, 1), distance_computed_by_us (within 1e-6 m). A case\n"
        "without any of them, or with another shape, is skipped. docs/distance.md explains the format.\n"
        "\nExit code 1: a distance is wrong.");
    registry.on(command, [&distance] { return run_distance(distance); });
}

}  // namespace fase::cli
