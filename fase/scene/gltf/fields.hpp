#pragma once
/// Reads and checks members of JSON objects. Internal to the glTF reader.
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fase/core/result.hpp"
#include "fase/math/quat.hpp"
#include "fase/scene/detail/json.hpp"

namespace fase::scene::gltf {

/// Ends the reading with an error; thrown and caught inside read_gltf() only.
struct Refusal {
    Error error;
};

/// Refuses the file because of a value; its JSON pointer becomes `where`.
[[noreturn]] void refuse(JsonValue at, std::string problem, std::string remedy = {});
/// Refuses the file; `where` is used as given and may be empty.
[[noreturn]] void refuse_file(std::string where, std::string problem, std::string remedy = {});

/// Returns a member and checks its kind; nullopt if it is missing.
std::optional<JsonValue> member(JsonValue object, std::string_view key, JsonKind kind);
/// The same, but refuses an object without it.
JsonValue required_member(JsonValue object, std::string_view key, JsonKind kind);
/// Returns object.extensions[name]; nullopt if either is missing.
std::optional<JsonValue> extension(JsonValue object, std::string_view name);

/// A number within ±1e30, so that products of a few stay finite.
double number_in(JsonValue object, std::string_view key, double fallback);
std::optional<double> optional_number(JsonValue object, std::string_view key);
bool flag_in(JsonValue object, std::string_view key, bool fallback);
std::optional<std::string_view> text_in(JsonValue object, std::string_view key);
/// A whole number from 0 to `max_value`.
std::optional<std::uint64_t> whole_in(JsonValue object, std::string_view key, std::uint64_t max_value = 1ull << 53);
/// An index below `count` in the file's array `what`. -1 means absent, as in OMI's extensions.
std::optional<std::uint32_t> index_in(JsonValue object, std::string_view key, std::size_t count, std::string_view what);
/// The value itself as such an index.
std::uint32_t index_of(JsonValue value, std::size_t count, std::string_view what);
/// An array of exactly out.size() numbers; false if the member is missing.
bool numbers_in(JsonValue object, std::string_view key, std::span<double> out);
std::optional<Vec3d> vec3_in(JsonValue object, std::string_view key);
/// A quaternion x, y, z, w. Its length must be 1 within 1e-2; it is normalized unless its squared length is within
/// 1e-6.
std::optional<Quatd> rotation_in(JsonValue object, std::string_view key);

/// The elements of an array of objects, 4 bytes each. Empty if the file has no such array.
class Table {
public:
    Table() = default;
    /// Reads object[name]; its elements must be objects.
    Table(const JsonDocument& document, JsonValue object, std::string_view name);
    [[nodiscard]] std::size_t size() const { return indices_.size(); }
    [[nodiscard]] bool empty() const { return indices_.empty(); }
    [[nodiscard]] JsonValue operator[](std::size_t i) const { return document_->at(indices_[i]); }

private:
    const JsonDocument* document_ = nullptr;
    std::vector<std::uint32_t> indices_;
};

/// What unsupported content does to a scene; the worst first.
enum class Harm : std::uint8_t {
    Missing,  ///< something is not simulated
    Changed,  ///< something is simulated otherwise
    Unknown,  ///< a part of the file that the reader does not know
    Unseen,   ///< something is not drawn
};

/// Warnings about unsupported content, counted.
class Warnings {
public:
    void add(const std::string& text, Harm harm = Harm::Changed) { ++counts_[{harm, text}][""]; }
    /// Adds `text` with `name` in place of its "{}". Texts that differ only in names are summarised.
    void add_named(const std::string& text, const std::string& name, Harm harm) { ++counts_[{harm, text}][name]; }
    /// Adds "NAME KEY is not supported" for every member of `object` that is not in `known`.
    void unknown_members(JsonValue object, std::string_view name, std::initializer_list<std::string_view> known);
    /// Returns "text" or "text (3 times)" for each warning, the worst first, then in alphabetical order. More than
    /// three names of one text become "text with the first name, and 9 more of this kind (20 times)".
    [[nodiscard]] std::vector<std::string> texts() const;

private:
    std::map<std::pair<Harm, std::string>, std::map<std::string, std::size_t>> counts_;
};

}  // namespace fase::scene::gltf
