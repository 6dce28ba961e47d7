#pragma once
/// Random lives: lists of calls that add, remove, change, step, save and restore, played in several worlds at once.
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "bench/checks/case.hpp"

namespace fase::checks {

/// What a call does. Its target and numbers follow from Call::seed and from the bodies of the world.
enum class CallKind : std::uint8_t {
    AddBody,
    AddCollider,
    RemoveBody,
    RemoveCollider,
    SetPose,
    SetVelocity,
    SetKind,
    SetMaterial,
    SetFilter,
    SetLocks,
    SetGravityScale,
    SetCanSleep,
    SetGravity,
    ExcludePair,
    ApplyImpulse,
    Wake,
    Steps,
    Save,
    Restore,
    Count
};
struct Call {
    CallKind kind = CallKind::Steps;
    std::uint64_t seed = 0;
};
using Life = std::vector<Call>;

/// Returns the life number `run`: about 80 calls, which begin with a ground and some bodies.
[[nodiscard]] Life random_life(std::uint64_t seed, int run);

/// Plays a life in three worlds: one thread, two threads with another structure, and a world that is restored from
/// each snapshot. Returns what differs, or what a refused call changed; "" when nothing does.
[[nodiscard]] std::string difference_in(const Life& life, const Context& context);

/// Leaves out calls of `life` as long as `fails` holds for what is left; it must hold for `life`. The result fails, and
/// no longer does without any one of its calls.
[[nodiscard]] Life shrunk(Life life, const std::function<bool(const Life&)>& fails);

/// Returns the calls of a life, one per line, with the numbers they use.
[[nodiscard]] std::string described(const Life& life);

}  // namespace fase::checks
