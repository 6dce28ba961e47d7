#pragma once
/// What a check is: a scene, the quantities that are measured in it, and the limits of each.
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fase::checks {

inline constexpr double no_limit = std::numeric_limits<double>::infinity();

/// One measured quantity. It is ok when it is finite and `low` <= measured <= `high`.
struct Figure {
    std::string name;       ///< "sinks"; unique in its case
    std::string_view unit;  ///< "m", "%"; "" for counts
    double expected = 0;    ///< by theory
    double low = -no_limit, high = no_limit;
};
/// A figure whose expected value is 0 and whose absolute value is limited.
[[nodiscard]] inline Figure at_most(std::string name, std::string_view unit, double limit) {
    return {std::move(name), unit, 0, -limit, limit};
}
[[nodiscard]] inline Figure at_least(std::string name, std::string_view unit, double limit, double expected) {
    return {std::move(name), unit, expected, limit, no_limit};
}
[[nodiscard]] inline Figure near(std::string name, std::string_view unit, double expected, double tolerance) {
    return {std::move(name), unit, expected, expected - tolerance, expected + tolerance};
}
/// A count, or 1 for yes and 0 for no.
[[nodiscard]] inline Figure exactly(std::string name, double expected) {
    return {std::move(name), "", expected, expected, expected};
}
/// A figure that is shown only: every finite value is ok.
[[nodiscard]] inline Figure shown(std::string name, std::string_view unit) { return {std::move(name), unit}; }

/// What a case may use, and where it says why it failed.
struct Context {
    std::uint64_t seed = 1;
    int runs = 100;      ///< repetitions of random cases
    int threads = 1;     ///< of each world; 0: all cores
    bool quick = false;  ///< shortens long simulations
    /// Called in every step. False: stop; what the case returns is then ignored.
    std::function<bool()> keep_going = [] { return true; };
    std::string error{};  ///< a call of the library failed: no figure of the case counts
    std::string note{};   ///< one or more lines about a failure: the calls that lead to it
};

/// A scene and its figures.
struct Case {
    std::string name;  ///< unique in its suite
    std::vector<Figure> figures;
    bool slow = false;  ///< takes more than about 2 s, even when shortened by Context::quick
    /// Simulates and returns one value per figure, in their order.
    std::function<std::vector<double>(Context&)> measure;
};

/// A list of cases about one subject.
struct Suite {
    std::string_view name;
    std::string_view description;  ///< one sentence
    std::vector<Case> (*cases)();
};

}  // namespace fase::checks
