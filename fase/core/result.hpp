#pragma once
/// A value or an error in words; stands in for std::expected, which g++ 12 in C++20 lacks.
#include <cassert>
#include <string>
#include <utility>
#include <variant>

namespace fase {

/// What kind of refusal an Error is; programs branch on it, people read the text.
enum class Status {
    Ok,
    BadArgument,  ///< a number or a text that cannot be meant
    BadHandle,    ///< an id that is stale, of another world, or never was
    OutOfRange,   ///< an index past the end, a coordinate past the stated range
    Capacity,     ///< a limit that the user set is reached
    NoMemory,
    Io,           ///< cannot open, read or write
    Format,       ///< a file that is not what it should be
    Unsupported,  ///< understood, but not done here
    Busy,         ///< not now: the world is being stepped
};

/// "BadArgument", "Io" …
[[nodiscard]] constexpr const char* name_of(Status status) {
    switch (status) {
        case Status::Ok: return "Ok";
        case Status::BadArgument: return "BadArgument";
        case Status::BadHandle: return "BadHandle";
        case Status::OutOfRange: return "OutOfRange";
        case Status::Capacity: return "Capacity";
        case Status::NoMemory: return "NoMemory";
        case Status::Io: return "Io";
        case Status::Format: return "Format";
        case Status::Unsupported: return "Unsupported";
        case Status::Busy: return "Busy";
    }
    return "?";
}

/// What went wrong with something that came from outside, in words for the person who sent it.
struct Error {
    Status status = Status::BadArgument;
    std::string where;    ///< file, byte, node, field: "scene.gltf: nodes[3].mass", "BodyDef.position"
    std::string problem;  ///< "found -2, need a number above 0"
    std::string remedy;   ///< "leave it out for a static body"; may be empty

    /// One line: "where: problem; remedy".
    [[nodiscard]] std::string text() const {
        std::string line = where.empty() ? problem : where + ": " + problem;
        if (!remedy.empty()) line += "; " + remedy;
        return line;
    }
};

/// A value, or the Error that stands in its place. Test it before it is opened: opening the wrong side is a broken
/// contract (assert in debug).
template <class T> class [[nodiscard]] Result {
public:
    Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}
    explicit operator bool() const { return state_.index() == 0; }
    [[nodiscard]] bool has_value() const { return state_.index() == 0; }
    T& operator*() & {
        assert(has_value());
        return *std::get_if<0>(&state_);
    }
    T&& operator*() && {
        assert(has_value());
        return std::move(*std::get_if<0>(&state_));
    }
    const T& operator*() const& {
        assert(has_value());
        return *std::get_if<0>(&state_);
    }
    T* operator->() { return &**this; }
    const T* operator->() const { return &**this; }
    const Error& error() const {
        assert(!has_value());
        return *std::get_if<1>(&state_);
    }
    /// Status::Ok, or the error's.
    [[nodiscard]] Status status() const { return has_value() ? Status::Ok : error().status; }

private:
    std::variant<T, Error> state_;
};

/// Done, or the Error that says why not.
template <> class [[nodiscard]] Result<void> {
public:
    Result() = default;
    Result(Error error) : error_(std::move(error)), failed_(true) {}
    explicit operator bool() const { return !failed_; }
    [[nodiscard]] bool has_value() const { return !failed_; }
    const Error& error() const {
        assert(failed_);
        return error_;
    }
    [[nodiscard]] Status status() const { return failed_ ? error_.status : Status::Ok; }

private:
    Error error_;
    bool failed_ = false;
};

}  // namespace fase
