#pragma once
/// Writes small traces for tests of the command.
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "fase/record/trace.hpp"
#include "tests/cli/fase_program.hpp"

namespace fase::cli {

inline Aabb cube_at(float x, float y = 0, float z = 0) { return {{x, y, z}, {x + 1, y + 1, z + 1}}; }

/// Writes a trace of these frames.
inline void write_trace(const std::string& name, const std::vector<std::vector<Aabb>>& frames,
                        const std::vector<std::uint8_t>& flags) {
    auto writer = record::TraceWriter::create(name, frames.at(0).size());
    ASSERT_TRUE(writer) << writer.error().text();
    for (const auto& frame : frames) ASSERT_TRUE(writer->add_frame(frame));
    const auto finished = writer->finish(flags);
    ASSERT_TRUE(finished) << finished.error().text();
}

/// The `--json` output of a command as an array; owns the document.
class Rows {
public:
    explicit Rows(const std::string& text) : document_(scene::parse_json(text)) {
        EXPECT_TRUE(document_) << text;
        if (!document_) return;
        EXPECT_TRUE(document_->root().is(scene::JsonKind::Array)) << text;
        document_->root().for_each_element([&](const scene::JsonValue& row) { rows_.push_back(row); });
    }
    [[nodiscard]] std::size_t size() const { return rows_.size(); }
    [[nodiscard]] const scene::JsonValue& operator[](std::size_t i) const { return rows_.at(i); }

private:
    decltype(scene::parse_json("")) document_;
    std::vector<scene::JsonValue> rows_;
};

inline scene::JsonKind kind_at(const scene::JsonValue& object, const std::string& key) {
    const auto value = object.find(key);
    EXPECT_TRUE(value) << key;
    return value ? value->kind() : scene::JsonKind::Null;
}
inline bool is_true(const scene::JsonValue& object, const std::string& key) {
    const auto value = object.find(key);
    return value && value->is(scene::JsonKind::True);
}

}  // namespace fase::cli
