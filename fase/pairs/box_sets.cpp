/// The choice of structures for the three sets of boxes, and searches over all sets.
#include "fase/pairs/box_sets.hpp"

#include <array>

namespace fase::pairs {
namespace {
constexpr std::array all_states{MotionState::Awake, MotionState::Asleep, MotionState::Static};
}

BoxSets BoxSets::automatic(broad::BoxUse awake_use) {
    BoxSets sets;
    sets.automatic_ = true;
    sets.awake_use_ = awake_use;
    return sets;
}

void BoxSets::build(MotionState state, std::span<const broad::Move> boxes) {
    broad::AnyStructure& set = of(state);
    if (automatic_) {
        set.clear();
        set.convert_to(
            *broad::AnyStructure::named(broad::choose_structure(broad::statistics_of(boxes, use_of(state)), {})));
    }
    state == MotionState::Awake ? set.build(boxes) : set.build_static(boxes);
}

void BoxSets::commit(TaskRunner& tasks, bool inspect) {
    for (const MotionState state : all_states) {
        if (automatic_) broad::update_auto_structure(of(state), use_of(state), inspect);
        of(state).commit(tasks);
    }
}

void BoxSets::commit_as_they_are() {
    for (const MotionState state : all_states) of(state).commit();
}

void BoxSets::clear() {
    for (const MotionState state : all_states) of(state).clear();
}

void BoxSets::find_awake_pairs(TaskRunner& tasks, std::vector<broad::Pair>& out) const {
    const broad::AnyStructure& awake = of(MotionState::Awake);
    awake.find_pairs(tasks, out);
    awake.find_pairs_between(tasks, of(MotionState::Asleep), out);
    awake.find_pairs_between(tasks, of(MotionState::Static), out);
}

void BoxSets::find_pairs_of(TaskRunner& tasks, std::span<const broad::Move> queries,
                            std::span<const std::uint8_t> is_query, std::vector<broad::Pair>& out) const {
    for (const MotionState state : all_states)
        if (of(state).size() != 0) of(state).find_pairs_of(tasks, queries, is_query, out);
}

broad::StructureChoice BoxSets::chosen(MotionState state) const {
    const std::string_view name = of(state).info().name;
    return {name, automatic_ ? broad::choice_reason(name) : std::string_view()};
}

}  // namespace fase::pairs
