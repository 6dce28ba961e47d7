#pragma once
/// Reading members of JSON objects with their checks; used inside the glTF reader only.
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fase/core/result.hpp"
#include "fase/math/quat.hpp"
#include "fase/scene/detail/json.hpp"

namespace fase::scene::gltf {

/// What ends the reading; thrown and caught inside read_gltf(), never beyond it.
struct Refusal {
    Error error;
};

/// Refuses the file because of a value: `where` becomes its JSON pointer.
[[noreturn]] void refuse(JsonValue at, std::string problem, std::string remedy = {});
/// Refuses the file as a whole; `where` as given, may be empty.
[[noreturn]] void refuse_file(std::string where, std::string problem, std::string remedy = {});

/// The member of that name, which must be of the kind; nullopt when it is not there.
std::optional<JsonValue> member(JsonValue object, std::string_view key, JsonKind kind);
/// The same, refusing an object that lacks it.
JsonValue needed(JsonValue object, std::string_view key, JsonKind kind);
/// object.extensions[name], when both are there.
std::optional<JsonValue> extension(JsonValue object, std::string_view name);

/// A number; within ±1e30, so that products of a few stay finite.
double number_in(JsonValue object, std::string_view key, double otherwise);
std::optional<double> optional_number(JsonValue object, std::string_view key);
bool flag_in(JsonValue object, std::string_view key, bool otherwise);
std::optional<std::string_view> text_in(JsonValue object, std::string_view key);
/// A whole number from 0 to `most`.
std::optional<std::uint64_t> whole_in(JsonValue object, std::string_view key, std::uint64_t most = 1ull << 53);
/// A whole number below `count`: the index of one of the file's `what`. -1 counts as absent, as OMI writes it.
std::optional<std::uint32_t> index_in(JsonValue object, std::string_view key, std::size_t count, std::string_view what);
/// An element of an array as an index.
std::uint32_t index_of(JsonValue value, std::size_t count, std::string_view what);
/// An array of as many numbers as `out` has places; false when the member is not there.
bool numbers_in(JsonValue object, std::string_view key, std::span<double> out);
std::optional<Vec3d> vec3_in(JsonValue object, std::string_view key);
/// A quaternion x, y, z, w of length 1 within 1e-2; kept as it is when within 1e-6, else normalised.
std::optional<Quatd> rotation_in(JsonValue object, std::string_view key);

/// The elements of one of the file's arrays of objects, 4 bytes each. Empty when the file has no such array.
class Table {
public:
    Table() = default;
    /// object[name], whose elements must be objects.
    Table(const JsonDocument& document, JsonValue object, std::string_view name);
    [[nodiscard]] std::size_t size() const { return indices_.size(); }
    [[nodiscard]] bool empty() const { return indices_.empty(); }
    [[nodiscard]] JsonValue operator[](std::size_t i) const { return document_->at(indices_[i]); }

private:
    const JsonDocument* document_ = nullptr;
    std::vector<std::uint32_t> indices_;
};

/// What was not understood, each text once, with how often it came.
class Notes {
public:
    void add(const std::string& text) { ++counts_[text]; }
    /// Notes every member of `object` that is not in `known` as "NAME KEY is not understood".
    void unknown_members(JsonValue object, std::string_view name, std::initializer_list<std::string_view> known);
    /// "text", or "text (3 times)"; in alphabetical order.
    [[nodiscard]] std::vector<std::string> texts() const;

private:
    std::map<std::string, std::size_t> counts_;
};

}  // namespace fase::scene::gltf
