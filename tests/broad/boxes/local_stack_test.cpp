#include "fase/broad/boxes/local_stack.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace fase::broad {
namespace {

TEST(LocalStack, PopsInReverseOrderBeyondItsLocalCapacity) {
    LocalStack<int, 4> stack;
    std::vector<int> model;
    int next = 0;
    for (int round = 0; round < 200; ++round) {
        for (int i = 0; i < round % 7; ++i) {
            stack.push(next);
            model.push_back(next++);
        }
        stack.reserve_more(1);
        stack.push_if(round % 2 == 0, next);
        if (round % 2 == 0) model.push_back(next++);
        for (int i = 0; i < round % 4 && !model.empty(); ++i) {
            ASSERT_EQ(stack.pop(), model.back());
            model.pop_back();
        }
        ASSERT_EQ(stack.empty(), model.empty());
    }
    for (; !model.empty(); model.pop_back()) ASSERT_EQ(stack.pop(), model.back());
    EXPECT_TRUE(stack.empty());
}

}  // namespace
}  // namespace fase::broad
