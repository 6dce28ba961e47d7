#pragma once
/// Writes JSON text piece by piece. Internal to the glTF writer.
#include <fmt/format.h>

#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "fase/math/quat.hpp"
#include "fase/scene/detail/json.hpp"

namespace fase::scene::gltf {

/// Appends to a JSON text and inserts commas. Numbers have the fewest digits that restore the same bits. A number that
/// is not finite is written as 0 and clears all_finite().
class JsonText {
public:
    JsonText& open(char bracket) {
        separate();
        text_ += bracket;
        first_ = true;
        return *this;
    }
    JsonText& close(char bracket) {
        text_ += bracket;
        first_ = false;
        return *this;
    }
    JsonText& key(std::string_view name) {
        separate();
        text_ += quoted(name);
        text_ += ':';
        first_ = true;
        return *this;
    }
    JsonText& text(std::string_view value) { return raw(quoted(value)); }
    JsonText& flag(bool value) { return raw(value ? "true" : "false"); }
    template <class T> JsonText& number(T value) {
        separate();
        if constexpr (std::is_floating_point_v<T>) {
            all_finite_ = all_finite_ && std::isfinite(value);
            if (!std::isfinite(value)) value = 0;
        }
        text_ += fmt::format("{}", value);
        return *this;
    }
    template <class T> JsonText& numbers(std::span<const T> values) {
        open('[');
        for (const T value : values) number(value);
        return close(']');
    }
    template <class T> JsonText& vector(Vec3Of<T> v) {
        const T values[]{v.x, v.y, v.z};
        return numbers(std::span<const T>(values));
    }
    template <class T> JsonText& rotation(QuatOf<T> q) {
        const T values[]{q.x, q.y, q.z, q.w};
        return numbers(std::span<const T>(values));
    }
    /// A value from another JsonText.
    JsonText& value(const JsonText& other) {
        all_finite_ = all_finite_ && other.all_finite_;
        return raw(other.text_);
    }
    /// A value in JSON form.
    JsonText& raw_json(std::string_view json) { return raw(json); }
    [[nodiscard]] const std::string& str() const { return text_; }
    [[nodiscard]] bool all_finite() const { return all_finite_; }

private:
    JsonText& raw(std::string_view value) {
        separate();
        text_ += value;
        return *this;
    }
    void separate() {
        if (!first_) text_ += ',';
        first_ = false;
    }
    std::string text_;
    bool first_ = true;
    bool all_finite_ = true;
};

}  // namespace fase::scene::gltf
