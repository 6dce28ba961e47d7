/// A frame of a warm structure does not allocate. This file counts the allocations of the whole test program.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <new>

#include "tests/conformance/lives.hpp"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define FASE_TEST_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define FASE_TEST_SANITIZED 1
#endif
#endif

#ifndef FASE_TEST_SANITIZED
namespace {
std::atomic<std::size_t> allocations{0};

void* counted(std::size_t size, std::size_t alignment) {
    allocations.fetch_add(1, std::memory_order_relaxed);
    size = size == 0 ? 1 : size;
    void* memory = alignment > alignof(std::max_align_t)
                       ? std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment)
                       : std::malloc(size);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
}
}  // namespace

[[gnu::noinline]] void* operator new(std::size_t size) { return counted(size, 0); }
[[gnu::noinline]] void* operator new[](std::size_t size) { return counted(size, 0); }
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
    return counted(size, static_cast<std::size_t>(alignment));
}
[[gnu::noinline]] void* operator new[](std::size_t size, std::align_val_t alignment) {
    return counted(size, static_cast<std::size_t>(alignment));
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete[](void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete[](void* memory, std::align_val_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
#endif

namespace fase::conformance {
namespace {

class EveryFrame : public ::testing::TestWithParam<std::string> {};

/// 300 boxes that oscillate with a period of 16 frames.
class Swinging {
public:
    Swinging() {
        Random random(3);
        for (Proxy p = 0; p < 300; ++p) places_.push_back({p, draw_uniform(random)});
        boxes = places_;
    }
    std::vector<Move> boxes;
    void swing(int frame) {
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            const auto angle = 0.39269908f * static_cast<float>((static_cast<std::size_t>(frame) + 5 * i) % 16);
            const Vec3 by = Vec3{std::sin(angle), std::cos(angle), std::sin(angle)} * 0.3f;
            boxes[i].box = {places_[i].box.lo + by, places_[i].box.hi + by};
        }
    }

private:
    std::vector<Move> places_;
};

TEST_P(EveryFrame, OfAWarmStructureDoesNotAllocate) {
#ifdef FASE_TEST_SANITIZED
    GTEST_SKIP() << "skipped: a sanitizer replaces the allocator";
#else
    AnyStructure structure = *AnyStructure::named(GetParam());
    Swinging scene;
    std::vector<Pair> pairs;
    std::size_t hits = 0;
    const broad::RayMeasure ray({{-1, 6, 6}, {1, 0, 0}, 20});
    const auto frame = [&](int i) {
        scene.swing(i);
        structure.move(scene.boxes);
        structure.commit();
        pairs.clear();
        structure.find_pairs(pairs);
        pairs.clear();
        structure.find_awake_pairs(pairs);
        structure.nearest_first(ray, broad::infinite_distance, [&](Proxy, const Aabb&, float at) {
            ++hits;
            return at;
        });
    };
    structure.insert(scene.boxes);
    structure.commit();
    int now = 0;
    for (; now < 64; ++now) frame(now);
    std::size_t allocated = 0;
    for (; now < 164; ++now) {
        const std::size_t before = allocations;
        frame(now);
        allocated += allocations - before;
    }
    EXPECT_EQ(allocated, 0u) << "in 100 frames";
    EXPECT_GT(pairs.size(), 100u);
    EXPECT_GT(hits, 100u);
    const std::size_t before = allocations;
    int* volatile number = new int(7);  // volatile: compilers may elide an allocation that nobody reads
    delete number;
    EXPECT_GT(allocations, before) << "the test counts nothing";
#endif
}

INSTANTIATE_TEST_SUITE_P(Registry, EveryFrame, ::testing::ValuesIn(structure_names()),
                         [](const ::testing::TestParamInfo<std::string>& name) { return name.param; });

}  // namespace
}  // namespace fase::conformance
