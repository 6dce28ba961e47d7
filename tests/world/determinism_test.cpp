// Determinism: the same calls give the same bits for any number of threads, structure and SIMD width, and after a
// snapshot.
#include "fase/broad/registry.hpp"
#include "fase/world/detail/state_access.hpp"
#include "tests/world/worlds.hpp"

namespace fase {
namespace {

using namespace test;

std::uint64_t hash_after(const Setup& setup, int steps, bool reference = false) {
    World world = make_world({}, setup);
    WorldStateAccess::of(world).solver.reference = reference;
    add_pile(world, 150);
    for (int i = 0; i < steps; ++i) EXPECT_TRUE(world.step());
    return world.hash();
}

TEST(Determinism, a_pile_hashes_the_same_for_any_number_of_threads) {
    const std::uint64_t one = hash_after({.threads = 1}, 300);
    EXPECT_EQ(hash_after({.threads = 2}, 300), one);
    EXPECT_EQ(hash_after({.threads = 4}, 300), one);
}

TEST(Determinism, a_pile_hashes_the_same_with_every_structure) {
    const std::uint64_t reference = hash_after({.structure = "brute_force"}, 300);
    broad::for_each_structure([&]<broad::Structure S>() {
        EXPECT_EQ(hash_after({.structure = std::string(broad::StructureInfo(S::info).name)}, 300), reference)
            << broad::StructureInfo(S::info).name;
    });
}

TEST(Determinism, a_pile_has_its_golden_hash) {
    // A new value means that the simulation changed, on every machine; the changelog must say why.
    EXPECT_EQ(hash_after({}, 300), 0x1aff82f06faf8e20u);
}

TEST(Determinism, wide_lanes_give_the_bits_of_the_scalar_reference) {
    EXPECT_EQ(hash_after({}, 200, true), hash_after({}, 200, false));
}

TEST(Determinism, a_user_supplied_scheduler_gives_the_same_hash) {
    struct Backwards final : TaskRunner {
        void run(std::size_t count, const std::function<void(std::size_t)>& chunk) override {
            for (std::size_t i = count; i-- > 0;) chunk(i);
        }
        [[nodiscard]] int threads() const override { return 3; }
    } backwards;
    EXPECT_EQ(hash_after({.tasks = &backwards}, 200), hash_after({}, 200));
}

TEST(Determinism, a_restored_snapshot_continues_with_the_same_bits) {
    for (const int before : {0, 1, 40, 250}) {
        World world = make_world();
        add_pile(world, 80);
        for (int i = 0; i < before; ++i) ASSERT_TRUE(world.step());
        const std::uint64_t saved_hash = world.hash();
        const std::vector<std::byte> saved = world.snapshot();
        World other = make_world({}, {.structure = "brute_force", .threads = 2});
        add_pile(other, 5);
        ASSERT_TRUE(other.restore(saved));
        EXPECT_EQ(other.hash(), saved_hash);
        for (int i = 0; i < 120; ++i) {
            ASSERT_TRUE(world.step());
            ASSERT_TRUE(other.step());
            ASSERT_EQ(other.hash(), world.hash()) << "snapshot after " << before << ", step " << i;
        }
        ASSERT_TRUE(world.restore(saved));
        EXPECT_EQ(world.hash(), saved_hash);
    }
}

TEST(Determinism, a_damaged_snapshot_is_refused_and_changes_nothing) {
    World world = make_world();
    add_pile(world, 3);
    ASSERT_TRUE(world.step());
    const std::vector<std::byte> saved = world.snapshot();
    const std::uint64_t before = world.hash();
    for (std::size_t size = 0; size < saved.size(); size += 1 + size / 64) {
        const auto result = world.restore(std::span(saved).first(size));
        ASSERT_FALSE(result) << size;
        ASSERT_EQ(result.status(), Status::Format);
    }
    for (std::size_t at = 0; at < saved.size(); at += 1 + at / 256) {
        std::vector<std::byte> flipped = saved;
        flipped[at] ^= std::byte{0x10};
        ASSERT_FALSE(world.restore(flipped)) << at;
    }
    EXPECT_EQ(world.hash(), before);
}

}  // namespace
}  // namespace fase
