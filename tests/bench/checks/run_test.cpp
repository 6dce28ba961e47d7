/// Rows of a case: which values are ok, and what happens when a case fails or is stopped.
#include "bench/checks/run.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace fase::checks {
namespace {

Case case_with(std::vector<Figure> figures, std::vector<double> values) {
    return {"a", std::move(figures), false, [=](Context&) { return values; }};
}

TEST(RunCase, a_figure_is_ok_within_its_limits) {
    const double nan = std::nan("");
    const Case one =
        case_with({at_most("small", "m", 1), at_most("large", "m", 1), near("near", "m", 3, 0.5), exactly("count", 2),
                   at_least("least", "m", 1, 2), shown("shown", ""), shown("shown_nan", "")},
                  {-1, 1.01, 3.5, 1, 7, 1e9, nan});
    std::vector<bool> ok;
    for (const Row& row : run_case("s", one, {})) ok.push_back(row.ok);
    EXPECT_EQ(ok, (std::vector<bool>{true, false, true, false, true, true, false}));
}

TEST(RunCase, an_error_leaves_no_figure_ok) {
    Case one = case_with({at_most("x", "m", 1), shown("y", "m")}, {});
    one.measure = [](Context& context) -> std::vector<double> {
        context.error = "World::step: found X";
        return {};
    };
    const std::vector<Row> rows = run_case("s", one, {});
    ASSERT_EQ(rows.size(), 2u);
    for (const Row& row : rows) {
        EXPECT_FALSE(row.ok);
        EXPECT_TRUE(std::isnan(row.measured));
    }
    EXPECT_EQ(rows[0].note, "World::step: found X");
    EXPECT_EQ(rows[0].name, "a/x");
}

TEST(RunCase, too_few_values_are_an_error) {
    const std::vector<Row> rows = run_case("s", case_with({shown("x", ""), shown("y", "")}, {1}), {});
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_FALSE(rows[0].ok);
    EXPECT_NE(rows[0].note.find("one per figure"), std::string::npos);
}

TEST(RunCase, a_stopped_case_has_no_rows) {
    Case one = case_with({shown("x", "")}, {1});
    one.measure = [](Context& context) -> std::vector<double> { return {context.keep_going() ? 1.0 : 0.0}; };
    Context context;
    context.keep_going = [] { return false; };
    EXPECT_TRUE(run_case("s", one, context).empty());
}

}  // namespace
}  // namespace fase::checks
