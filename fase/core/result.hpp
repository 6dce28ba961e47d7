#pragma once
/// A value or an error with a message; replaces std::expected, which g++ 12 in C++20 lacks.
#include <cassert>
#include <concepts>
#include <string>
#include <utility>
#include <variant>

namespace fase {

/// The category of an Error; programs branch on it, people read the text.
enum class Status {
    Ok,
    BadArgument,  ///< a number or a text that is not valid
    BadHandle,    ///< an id that is stale, of another world, or was never issued
    OutOfRange,   ///< an index past the end, a coordinate past the stated range
    Capacity,     ///< a limit that the user set is reached
    NoMemory,
    Io,           ///< cannot open, read or write
    Format,       ///< a file with invalid content
    Unsupported,  ///< valid, but not supported
    Busy,         ///< not possible while the world is being stepped
};

/// Returns the name of the enumerator: "BadArgument", "Io" …
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

/// An error in the user's input, described for the user.
struct Error {
    Status status = Status::BadArgument;
    std::string where;    ///< file, byte, node, field: "scene.gltf: nodes[3].mass", "BodyDef.position"
    std::string problem;  ///< "found -2; expected a number above 0"
    std::string remedy;   ///< "leave it out for a static body"; may be empty

    /// Returns one line: "where: problem; remedy".
    [[nodiscard]] std::string text() const {
        std::string line = where.empty() ? problem : where + ": " + problem;
        if (!remedy.empty()) line += "; " + remedy;
        return line;
    }
};

/// A value or an Error. Test it before access: access to the wrong alternative breaks the contract (assert in debug).
template <class T> class [[nodiscard]] Result {
public:
    Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}
    /// From a result whose value converts implicitly.
    template <class U>
    requires(!std::same_as<U, T> && std::convertible_to<const U&, T>) Result(const Result<U>& other)
        : Result(other ? Result(static_cast<T>(*other)) : Result(other.error())) {}
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
    /// Returns the value, or `other` when there is none.
    template <class U> [[nodiscard]] T value_or(U&& other) const& {
        return has_value() ? **this : static_cast<T>(std::forward<U>(other));
    }
    template <class U> [[nodiscard]] T value_or(U&& other) && {
        return has_value() ? *std::move(*this) : static_cast<T>(std::forward<U>(other));
    }
    const Error& error() const {
        assert(!has_value());
        return *std::get_if<1>(&state_);
    }
    /// Returns Status::Ok or the status of the error.
    [[nodiscard]] Status status() const { return has_value() ? Status::Ok : error().status; }

private:
    std::variant<T, Error> state_;
};

/// Success or an Error.
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
