/// Checks each value and reports its place in the file.
#include "fase/scene/gltf/fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace fase::scene::gltf {

void refuse(JsonValue at, std::string problem, std::string remedy) {
    const std::string pointer = at.pointer();
    throw Refusal{{Status::Format, pointer.empty() ? "/" : pointer, std::move(problem), std::move(remedy)}};
}

void refuse_file(std::string where, std::string problem, std::string remedy) {
    throw Refusal{{Status::Format, std::move(where), std::move(problem), std::move(remedy)}};
}

namespace {

[[noreturn]] void refuse_kind(JsonValue at, std::string_view need) {
    refuse(at, fmt::format("found {}; expected {}", name_of(at.kind()), need));
}

double checked_number(JsonValue value) {
    if (!value.is(JsonKind::Number)) refuse_kind(value, "a number");
    if (!(std::abs(value.number()) <= 1e30))
        refuse(value, fmt::format("found {}; expected a number within 1e30", value.number()));
    return value.number();
}

std::uint64_t checked_whole(JsonValue value, std::uint64_t max_value) {
    if (!value.is(JsonKind::Number)) refuse_kind(value, "a whole number");
    const double number = value.number();
    if (!(number >= 0 && number <= static_cast<double>(max_value) && number == std::floor(number))) {
        refuse(value, fmt::format("found {}; expected a whole number from 0 to {}", number, max_value));
    }
    return static_cast<std::uint64_t>(number);
}

}  // namespace

std::optional<JsonValue> member(JsonValue object, std::string_view key, JsonKind kind) {
    const std::optional<JsonValue> value = object.find(key);
    if (value && !value->is(kind)) refuse_kind(*value, name_of(kind));
    return value;
}

JsonValue required_member(JsonValue object, std::string_view key, JsonKind kind) {
    const std::optional<JsonValue> value = member(object, key, kind);
    if (!value) refuse(object, fmt::format("found no \"{}\"; expected {}", key, name_of(kind)));
    return *value;
}

std::optional<JsonValue> extension(JsonValue object, std::string_view name) {
    const std::optional<JsonValue> all = member(object, "extensions", JsonKind::Object);
    return all ? member(*all, name, JsonKind::Object) : std::nullopt;
}

std::optional<double> optional_number(JsonValue object, std::string_view key) {
    const std::optional<JsonValue> value = object.find(key);
    if (!value) return std::nullopt;
    return checked_number(*value);
}

double number_in(JsonValue object, std::string_view key, double fallback) {
    return optional_number(object, key).value_or(fallback);
}

bool flag_in(JsonValue object, std::string_view key, bool fallback) {
    const std::optional<JsonValue> value = object.find(key);
    if (!value) return fallback;
    if (!value->is(JsonKind::True) && !value->is(JsonKind::False)) refuse_kind(*value, "true or false");
    return value->is(JsonKind::True);
}

std::optional<std::string_view> text_in(JsonValue object, std::string_view key) {
    const std::optional<JsonValue> value = member(object, key, JsonKind::String);
    if (!value) return std::nullopt;
    return value->string();
}

std::optional<std::uint64_t> whole_in(JsonValue object, std::string_view key, std::uint64_t max_value) {
    const std::optional<JsonValue> value = object.find(key);
    if (!value) return std::nullopt;
    return checked_whole(*value, max_value);
}

std::uint32_t index_of(JsonValue value, std::size_t count, std::string_view what) {
    const std::uint64_t index = checked_whole(value, 1ull << 53);
    if (index >= count)
        refuse(value, fmt::format("found index {}; expected one below {}, the number of {}", index, count, what));
    return static_cast<std::uint32_t>(index);
}

std::optional<std::uint32_t> index_in(JsonValue object, std::string_view key, std::size_t count,
                                      std::string_view what) {
    const std::optional<JsonValue> value = object.find(key);
    if (!value || (value->is(JsonKind::Number) && value->number() == -1)) return std::nullopt;
    return index_of(*value, count, what);
}

bool numbers_in(JsonValue object, std::string_view key, std::span<double> out) {
    const std::optional<JsonValue> array = member(object, key, JsonKind::Array);
    if (!array) return false;
    if (array->size() != out.size())
        refuse(*array, fmt::format("found {} elements; expected {}", array->size(), out.size()));
    std::size_t i = 0;
    array->for_each_element([&](JsonValue value) { out[i++] = checked_number(value); });
    return true;
}

std::optional<Vec3d> vec3_in(JsonValue object, std::string_view key) {
    double v[3];
    if (!numbers_in(object, key, v)) return std::nullopt;
    return Vec3d{v[0], v[1], v[2]};
}

std::optional<Quatd> rotation_in(JsonValue object, std::string_view key) {
    double v[4];
    if (!numbers_in(object, key, v)) return std::nullopt;
    const Quatd q{v[0], v[1], v[2], v[3]};
    const double squared = length_squared(q);
    if (!(std::abs(std::sqrt(squared) - 1) <= 1e-2)) {
        refuse(*object.find(key),
               fmt::format("found a quaternion of length {:.4g}; expected length 1", std::sqrt(squared)));
    }
    return std::abs(squared - 1) <= 1e-6 ? q : normalized(q);
}

Table::Table(const JsonDocument& document, JsonValue object, std::string_view name) : document_(&document) {
    const std::optional<JsonValue> array = member(object, name, JsonKind::Array);
    if (!array) return;
    indices_.reserve(array->size());
    array->for_each_element([&](JsonValue value) {
        if (!value.is(JsonKind::Object)) refuse_kind(value, "an object");
        indices_.push_back(value.index());
    });
}

void Warnings::unknown_members(JsonValue object, std::string_view name, std::initializer_list<std::string_view> known) {
    object.for_each_member([&](std::string_view key, JsonValue) {
        const bool always_allowed = key == "extras" || key == "extensions" || key == "name";
        if (always_allowed || std::find(known.begin(), known.end(), key) != known.end()) return;
        add_named(fmt::format("{} {{}} is not supported", name), quoted_short(key), Harm::Unknown);
    });
}

std::vector<std::string> Warnings::texts() const {
    constexpr std::size_t max_names = 3;
    std::vector<std::string> all;
    const auto add = [&](const std::string& text, std::size_t count) {
        all.push_back(count == 1 ? text : fmt::format("{} ({} times)", text, count));
    };
    for (const auto& [key, names] : counts_) {
        const auto with_name = [&text = key.second](const std::string& name) {
            const std::size_t at = name.empty() ? text.npos : text.find("{}");
            return at == text.npos ? text : text.substr(0, at) + name + text.substr(at + 2);
        };
        if (names.size() > max_names) {
            std::size_t total = 0;
            for (const auto& [name, count] : names) total += count;
            add(fmt::format("{}, and {} more of this kind", with_name(names.begin()->first), names.size() - 1), total);
            continue;
        }
        for (const auto& [name, count] : names) add(with_name(name), count);
    }
    return all;
}

}  // namespace fase::scene::gltf
