#pragma once
/// Strict JSON (RFC 8259) as a flat, compact tree that stores the text offset of each value.
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>

#include "fase/core/result.hpp"

namespace fase::scene {

enum class JsonKind : std::uint8_t { Null, False, True, Number, String, Array, Object };

/// "an object", "a number" … for messages.
[[nodiscard]] std::string_view name_of(JsonKind kind);

struct JsonOptions {
    int depth = 128;  ///< limit of nested arrays and objects
    /// Refuse an object with a duplicate key (glTF 2.0 section 2.7); otherwise find() returns the first one.
    bool unique_keys = true;
};

class JsonValue;

/// A parsed text. About 24 bytes per value, at most 13 times the text. JsonValues are views into it: it must outlive
/// them.
class JsonDocument {
public:
    [[nodiscard]] JsonValue root() const;
    /// The value with this index().
    [[nodiscard]] JsonValue at(std::uint32_t index) const;

private:
    friend class JsonValue;
    friend class JsonBuilder;
    struct Node {
        JsonKind kind = JsonKind::Null;
        std::uint32_t end = 0;     ///< one past the last node of this value
        std::uint32_t offset = 0;  ///< byte of the text at which the value ends
        std::uint32_t size = 0;    ///< bytes of a string, elements of an array, members of an object
        double number = 0;         ///< a number's value, or a string's offset in text_
    };
    // An object is followed by key, value, key, value …; an array by its elements.
    std::deque<Node> nodes_;
    std::string text_;
};

/// One value of a JsonDocument; a cheap view. number() and string() require a value of that kind.
class JsonValue {
public:
    /// Null, without a document.
    JsonValue() = default;
    [[nodiscard]] JsonKind kind() const { return document_ == nullptr ? JsonKind::Null : node().kind; }
    [[nodiscard]] bool is(JsonKind kind) const { return this->kind() == kind; }
    [[nodiscard]] double number() const { return node().number; }
    [[nodiscard]] std::string_view string() const;
    /// Number of elements or members; 0 for other kinds.
    [[nodiscard]] std::size_t size() const;
    /// The member `key`; nullopt if it is missing or this is not an object. O(members).
    [[nodiscard]] std::optional<JsonValue> find(std::string_view key) const;
    /// Its index in the document, see JsonDocument::at().
    [[nodiscard]] std::uint32_t index() const { return index_; }
    /// Its end in the text, in bytes from the start.
    [[nodiscard]] std::size_t offset() const { return node().offset; }
    /// JSON pointer, for example "/nodes/3/mesh" (RFC 6901). O(document): for messages.
    [[nodiscard]] std::string pointer() const;

    /// Calls f(value) for each element of an array, in order.
    template <class F> void for_each_element(F&& f) const {
        if (!is(JsonKind::Array)) return;
        for (std::uint32_t i = index_ + 1; i < node().end; i = document_->nodes_[i].end) f(JsonValue(document_, i));
    }
    /// Calls f(key, value) for each member of an object, in order.
    template <class F> void for_each_member(F&& f) const {
        if (!is(JsonKind::Object)) return;
        for (std::uint32_t i = index_ + 1; i < node().end; i = document_->nodes_[i + 1].end) {
            f(JsonValue(document_, i).string(), JsonValue(document_, i + 1));
        }
    }

private:
    friend class JsonDocument;
    JsonValue(const JsonDocument* document, std::uint32_t index) : document_(document), index_(index) {}
    [[nodiscard]] const JsonDocument::Node& node() const { return document_->nodes_[index_]; }
    const JsonDocument* document_ = nullptr;
    std::uint32_t index_ = 0;
};

inline JsonValue JsonDocument::root() const { return {this, 0}; }
inline JsonValue JsonDocument::at(std::uint32_t index) const { return {this, index}; }

/// Parses a text. Format, with "byte N" as `where`, for anything that RFC 8259 does not allow, a byte order mark, a
/// number outside the range of double, nesting above the limit, a duplicate key, or 4 GiB and more. Allocation failures
/// throw.
Result<JsonDocument> parse_json(std::string_view text, const JsonOptions& options = {});

/// Returns `text` in double quotes with control characters and invalid UTF-8 escaped, for messages and JSON files.
[[nodiscard]] std::string quoted(std::string_view text);
/// The same for at most `max_bytes` bytes of the text, followed by "…" if it is longer: for messages.
[[nodiscard]] std::string quoted_short(std::string_view text, std::size_t max_bytes = 60);

}  // namespace fase::scene
