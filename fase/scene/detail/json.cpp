/// Builds the flat tree from the events of nlohmann-json.
#include "fase/scene/detail/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "fase/core/detail/text.hpp"

namespace fase::scene {

std::string_view name_of(JsonKind kind) {
    switch (kind) {
        case JsonKind::Null: return "null";
        case JsonKind::False: return "false";
        case JsonKind::True: return "true";
        case JsonKind::Number: return "a number";
        case JsonKind::String: return "a text";
        case JsonKind::Array: return "an array";
        case JsonKind::Object: return "an object";
    }
    return "?";
}

namespace {

/// Iterates over a text and counts the consumed bytes.
class CountingIterator {
public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;
    CountingIterator(const char* position, std::size_t* consumed) : position_(position), consumed_(consumed) {}
    reference operator*() const { return *position_; }
    CountingIterator& operator++() {
        ++position_;
        ++*consumed_;
        return *this;
    }
    CountingIterator operator++(int) {
        CountingIterator old = *this;
        ++*this;
        return old;
    }
    bool operator==(const CountingIterator& other) const { return position_ == other.position_; }

private:
    const char* position_;
    std::size_t* consumed_;
};

}  // namespace

/// Receives the events of nlohmann-json; every callback returns whether to continue.
class JsonBuilder {
public:
    using Source = nlohmann::json;
    JsonBuilder(const JsonOptions& options, const std::size_t* consumed) : options_(options), consumed_(consumed) {}

    bool null() { return add(JsonKind::Null, 0); }
    bool boolean(bool value) { return add(value ? JsonKind::True : JsonKind::False, 0); }
    bool number_integer(Source::number_integer_t value) { return add(JsonKind::Number, static_cast<double>(value)); }
    bool number_unsigned(Source::number_unsigned_t value) { return add(JsonKind::Number, static_cast<double>(value)); }
    bool number_float(Source::number_float_t value, const std::string&) { return add(JsonKind::Number, value); }
    bool string(std::string& value) {
        const auto begin = static_cast<double>(document_.text_.size());
        document_.text_ += value;
        return add(JsonKind::String, begin, static_cast<std::uint32_t>(value.size()));
    }
    bool binary(Source::binary_t&) { return refuse("found binary data; expected text"); }
    bool key(std::string& value) {
        in_key_ = true;
        return string(value);
    }
    bool start_object(std::size_t) { return start(JsonKind::Object); }
    bool start_array(std::size_t) { return start(JsonKind::Array); }
    bool end_object() { return (!options_.unique_keys || keys_are_unique()) && end(); }
    bool end_array() { return end(); }
    bool parse_error(std::size_t, const std::string& token, const Source::exception& exception) {
        if (exception.id == 406)
            return refuse("found the number " + quoted_short(token) + "; expected one in the range of double");
        if (token.empty() || token == "<end of input>" || token == "<U+0000>") {
            return refuse(*consumed_ == 0 || token == "<end of input>"
                              ? "found the end of the text; expected a complete JSON value"
                              : "found no valid JSON");
        }
        return refuse("found " + quoted_short(token) + "; expected valid JSON here");
    }

    Result<JsonDocument> finish(bool complete) {
        if (!problem_.empty() || !complete) {
            return Error{Status::Format,
                         fase::detail::byte_text(*consumed_),
                         problem_.empty() ? "found no valid JSON" : problem_,
                         {}};
        }
        return std::move(document_);
    }

private:
    bool add(JsonKind kind, double number, std::uint32_t size = 0) {
        if (!in_key_ && !open_.empty()) ++document_.nodes_[open_.back()].size;
        in_key_ = false;
        const auto index = static_cast<std::uint32_t>(document_.nodes_.size());
        document_.nodes_.push_back({kind, index + 1, static_cast<std::uint32_t>(*consumed_), size, number});
        return true;
    }
    bool start(JsonKind kind) {
        if (static_cast<int>(open_.size()) >= options_.depth) {
            return refuse(fmt::format("found arrays and objects nested deeper than {}; expected at most {}",
                                      options_.depth, options_.depth));
        }
        add(kind, 0);
        open_.push_back(static_cast<std::uint32_t>(document_.nodes_.size() - 1));
        return true;
    }
    bool end() {
        document_.nodes_[open_.back()].end = static_cast<std::uint32_t>(document_.nodes_.size());
        open_.pop_back();
        return true;
    }
    bool keys_are_unique() {
        const std::uint32_t object = open_.back();
        if (document_.nodes_[object].size < 2) return true;
        keys_.clear();
        const auto end = static_cast<std::uint32_t>(document_.nodes_.size());
        for (std::uint32_t i = object + 1; i < end; i = document_.nodes_[i + 1].end) {
            const JsonDocument::Node& key = document_.nodes_[i];
            keys_.push_back(std::string_view(document_.text_).substr(static_cast<std::size_t>(key.number), key.size));
        }
        std::sort(keys_.begin(), keys_.end());
        const auto duplicate = std::adjacent_find(keys_.begin(), keys_.end());
        return duplicate == keys_.end() ||
               refuse("found the key " + quoted_short(*duplicate) + " twice in one object; expected it once");
    }
    bool refuse(std::string problem) {
        problem_ = std::move(problem);
        return false;
    }

    JsonOptions options_;
    const std::size_t* consumed_;
    JsonDocument document_;
    std::vector<std::uint32_t> open_;
    std::vector<std::string_view> keys_;
    std::string problem_;
    bool in_key_ = false;
};

Result<JsonDocument> parse_json(std::string_view text, const JsonOptions& options) {
    if (text.size() >= std::numeric_limits<std::uint32_t>::max()) {
        return Error{
            Status::Format, "byte 0", fmt::format("found {} bytes of JSON; expected less than 4 GiB", text.size()), {}};
    }
    if (text.starts_with("\xef\xbb\xbf")) {
        return Error{Status::Format, "byte 0", "found a byte order mark; expected JSON without one",
                     "save it as UTF-8 without BOM"};
    }
    if (const std::size_t nul = text.find('\0'); nul != text.npos) {  // nlohmann-json would stop here
        return Error{Status::Format, fase::detail::byte_text(nul), "found a NUL byte; expected valid JSON here", {}};
    }
    std::size_t consumed = 0;
    JsonBuilder builder(options, &consumed);
    const char* const begin = text.data();
    const bool complete = nlohmann::json::sax_parse(CountingIterator(begin, &consumed),
                                                    CountingIterator(begin + text.size(), &consumed), &builder);
    return builder.finish(complete);
}

std::string_view JsonValue::string() const {
    const JsonDocument::Node& n = node();
    return std::string_view(document_->text_).substr(static_cast<std::size_t>(n.number), n.size);
}

std::size_t JsonValue::size() const { return is(JsonKind::Array) || is(JsonKind::Object) ? node().size : 0; }

std::optional<JsonValue> JsonValue::find(std::string_view key) const {
    if (!is(JsonKind::Object)) return std::nullopt;
    for (std::uint32_t i = index_ + 1; i < node().end; i = document_->nodes_[i + 1].end) {
        if (JsonValue(document_, i).string() == key) return JsonValue(document_, i + 1);
    }
    return std::nullopt;
}

std::string JsonValue::pointer() const {
    if (document_ == nullptr) return {};
    std::string path;
    std::uint32_t current = 0;
    while (current != index_) {
        const JsonDocument::Node& parent = document_->nodes_[current];
        std::uint32_t child = current + 1, number = 0;
        if (parent.kind == JsonKind::Object) {
            while (document_->nodes_[child + 1].end <= index_) child = document_->nodes_[child + 1].end;
            path += '/';
            for (const char c : JsonValue(document_, child).string()) {
                path += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
            }
            if (child == index_) break;
            ++child;
        } else {
            for (; document_->nodes_[child].end <= index_; child = document_->nodes_[child].end) ++number;
            path += '/' + std::to_string(number);
        }
        current = child;
    }
    return path;
}

namespace {

/// Byte length of the valid UTF-8 sequence at the start of `text`; 0: none (RFC 3629).
std::size_t utf8_length(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char first = byte(0);
    if (first < 0x80) return 1;
    const std::size_t length = first >= 0xc2 && first < 0xe0   ? 2
                               : (first & 0xf0) == 0xe0        ? 3
                               : first >= 0xf0 && first < 0xf5 ? 4
                                                               : 0;
    if (length == 0 || text.size() < length) return 0;
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xc0) != 0x80) return 0;
    }
    const unsigned char second = byte(1);
    const bool invalid = (first == 0xe0 && second < 0xa0) || (first == 0xed && second > 0x9f) ||
                         (first == 0xf0 && second < 0x90) || (first == 0xf4 && second > 0x8f);
    return invalid ? 0 : length;
}

}  // namespace

std::string quoted(std::string_view text) {
    std::string out = "\"";
    for (std::size_t i = 0; i < text.size();) {
        const auto byte = static_cast<unsigned char>(text[i]);
        const std::size_t length = utf8_length(text.substr(i));
        if (byte == '"' || byte == '\\') {
            out += '\\';
            out += text[i];
        } else if (byte < 0x20 || byte == 0x7f) {
            out += fmt::format("\\u{:04x}", byte);
        } else if (length == 0) {
            out += "\\ufffd";
        } else {
            out += text.substr(i, length);
        }
        i += std::max<std::size_t>(length, 1);
    }
    return out + '"';
}

std::string quoted_short(std::string_view text, std::size_t max_bytes) {
    if (text.size() <= max_bytes) return quoted(text);
    std::size_t cut = max_bytes;
    while (cut > 0 && (static_cast<unsigned char>(text[cut]) & 0xc0) == 0x80) --cut;
    std::string out = quoted(text.substr(0, cut));
    out.insert(out.size() - 1, "…");
    return out;
}

}  // namespace fase::scene
