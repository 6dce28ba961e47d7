#pragma once
/// Strict JSON (RFC 8259) as a flat, compact tree that knows where in the text each value stood.
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
    int depth = 128;  ///< most arrays and objects inside each other
    bool unique_keys =
        true;  ///< refuse an object that has the same key twice (glTF 2.0 section 2.7); else the first counts
};

class JsonValue;

/// A parsed text. About 24 bytes a value, at most 13 times the text. Values are views into it: it must outlive them.
class JsonDocument {
public:
    [[nodiscard]] JsonValue root() const;
    /// The value whose index() this is.
    [[nodiscard]] JsonValue at(std::uint32_t index) const;

private:
    friend class JsonValue;
    friend class JsonBuilder;
    struct Node {
        JsonKind kind = JsonKind::Null;
        std::uint32_t end = 0;     ///< one past the last node of this value
        std::uint32_t offset = 0;  ///< byte of the text at which the value was complete
        std::uint32_t size = 0;    ///< bytes of a string, elements of an array, members of an object
        double number = 0;         ///< a number's value, or where in text_ a string begins
    };
    // An object's members follow it as key, value, key, value …; an array's elements as they are.
    std::deque<Node> nodes_;
    std::string text_;
};

/// One value of a JsonDocument; a cheap view. The wrong question for its kind is a broken contract.
class JsonValue {
public:
    /// Null, of no document.
    JsonValue() = default;
    [[nodiscard]] JsonKind kind() const { return document_ == nullptr ? JsonKind::Null : node().kind; }
    [[nodiscard]] bool is(JsonKind kind) const { return this->kind() == kind; }
    [[nodiscard]] double number() const { return node().number; }
    [[nodiscard]] std::string_view string() const;
    /// Elements or members; 0 for all else.
    [[nodiscard]] std::size_t size() const;
    /// The member of that name; nullopt when there is none or this is no object. O(members).
    [[nodiscard]] std::optional<JsonValue> find(std::string_view key) const;
    /// Its number among the document's values: see JsonDocument::at().
    [[nodiscard]] std::uint32_t index() const { return index_; }
    /// Where it ended in the text, in bytes from its start.
    [[nodiscard]] std::size_t offset() const { return node().offset; }
    /// "/nodes/3/mesh": the way from the root (RFC 6901). O(document): for messages.
    [[nodiscard]] std::string pointer() const;

    /// Calls f(value) for each element of an array, in order.
    template <class F> void for_each_element(F&& f) const {
        if (!is(JsonKind::Array)) return;
        for (std::uint32_t at = index_ + 1; at < node().end; at = document_->nodes_[at].end)
            f(JsonValue(document_, at));
    }
    /// Calls f(key, value) for each member of an object, in order.
    template <class F> void for_each_member(F&& f) const {
        if (!is(JsonKind::Object)) return;
        for (std::uint32_t at = index_ + 1; at < node().end; at = document_->nodes_[at + 1].end) {
            f(JsonValue(document_, at).string(), JsonValue(document_, at + 1));
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

/// Reads a text. Format, with "byte N" as `where`, for anything that RFC 8259 does not allow, a byte order mark, a
/// number that does not fit a double, nesting deeper than the options say, a key given twice, or 4 GiB and more.
/// Allocation failures throw.
Result<JsonDocument> parse_json(std::string_view text, const JsonOptions& options = {});

/// `text` in double quotes, control characters and broken UTF-8 escaped: fit for a message or a JSON file.
[[nodiscard]] std::string quoted(std::string_view text);
/// quoted(), of at most `most` bytes of the text, with "…" when there was more: for messages.
[[nodiscard]] std::string quoted_short(std::string_view text, std::size_t most = 60);

}  // namespace fase::scene
