/// Every quick case of `fase check` is within its limits, save the figures that known_failures.txt names.
#include "bench/checks/suites.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <ostream>
#include <regex>
#include <set>

#include "bench/checks/run.hpp"

namespace fase::checks {
namespace {

/// The figures that are outside their limits today, as "suite/case/figure".
const std::set<std::string>& known_failures() {
    static const std::set<std::string> all = [] {
        std::set<std::string> names;
        std::ifstream file(FASE_DATA "/../tests/bench/checks/known_failures.txt");
        EXPECT_TRUE(file);
        for (std::string line; std::getline(file, line);)
            if (!line.empty() && line[0] != '#') names.insert(line);
        return names;
    }();
    return all;
}

struct Chosen {
    std::string suite;
    Case one;
    friend void PrintTo(const Chosen& chosen, std::ostream* out) { *out << chosen.suite << '/' << chosen.one.name; }
};
std::vector<Chosen> all_cases() {
    std::vector<Chosen> all;
    for (const Suite* suite : suites())
        for (Case& one : suite->cases()) all.push_back({std::string(suite->name), std::move(one)});
    return all;
}
std::vector<Chosen> quick_cases() {
    std::vector<Chosen> all = all_cases();
    std::erase_if(all, [](const Chosen& chosen) { return chosen.one.slow; });
    return all;
}

TEST(Suites, have_unique_names_that_need_no_quotes) {
    const std::regex plain("[a-z][a-z0-9_]*");
    std::set<std::string> names;
    for (const Chosen& chosen : all_cases()) {
        EXPECT_TRUE(std::regex_match(chosen.suite, plain)) << chosen.suite;
        EXPECT_TRUE(std::regex_match(chosen.one.name, plain)) << chosen.one.name;
        EXPECT_FALSE(chosen.one.figures.empty()) << chosen.one.name;
        for (const Figure& figure : chosen.one.figures) {
            EXPECT_TRUE(std::regex_match(figure.name, plain)) << figure.name;
            EXPECT_TRUE(names.insert(chosen.suite + "/" + row_name(chosen.one, figure)).second)
                << row_name(chosen.one, figure);
        }
    }
}

TEST(Suites, expect_values_within_their_limits) {
    for (const Chosen& chosen : all_cases())
        for (const Figure& figure : chosen.one.figures) {
            EXPECT_LE(figure.low, figure.expected) << row_name(chosen.one, figure);
            EXPECT_LE(figure.expected, figure.high) << row_name(chosen.one, figure);
        }
}

TEST(Suites, known_failures_are_figures_of_quick_cases) {
    std::set<std::string> names;
    for (const Chosen& chosen : quick_cases())
        for (const Figure& figure : chosen.one.figures) names.insert(chosen.suite + "/" + row_name(chosen.one, figure));
    for (const std::string& known : known_failures()) EXPECT_TRUE(names.contains(known)) << known;
}

class QuickCase : public testing::TestWithParam<Chosen> {};

TEST_P(QuickCase, is_within_its_limits) {
    Context context;
    context.quick = true;
    context.runs = 20;
    const std::vector<Row> rows = run_case(GetParam().suite, GetParam().one, context);
    ASSERT_FALSE(rows.empty());
    for (const Row& row : rows) {
        const std::string name = row.suite + "/" + row.name;
        const bool known = known_failures().contains(name);
        EXPECT_TRUE(row.ok || known) << name << ": expected " << row.figure.expected << ", measured " << row.measured
                                     << ", limits " << row.figure.low << " to " << row.figure.high << "\n"
                                     << row.note;
        EXPECT_FALSE(row.ok && known) << name << " is within its limits now: delete its line in known_failures.txt";
    }
}

INSTANTIATE_TEST_SUITE_P(, QuickCase, testing::ValuesIn(quick_cases()),
                         [](const testing::TestParamInfo<Chosen>& chosen) {
                             return chosen.param.suite + "_" + chosen.param.one.name;
                         });

}  // namespace
}  // namespace fase::checks
