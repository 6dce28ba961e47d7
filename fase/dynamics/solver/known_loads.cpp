/// Known loads: passes weight down over the contacts, from the highest body to the lowest.
#include "fase/dynamics/solver/known_loads.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace fase::dynamics {
namespace {

constexpr std::size_t support_grain = 256;
constexpr float min_upward = 0.3f;  // cosine to the vertical: steeper contacts are taken to carry nothing

}  // namespace

void KnownLoads::sort_top_down(bool any_stack) {
    top_down_.clear();
    double top = -std::numeric_limits<double>::infinity();
    for (std::uint32_t row = 1; row + 1 < carriers_.size(); ++row)
        if (carriers_[row].first != carriers_[row].end) {
            top_down_.push_back(row);
            top = std::max(top, carriers_[row].height);
        }
    if (!any_stack) return;
    // Radix sort by depth below the highest: the bits of floats of 0 or more are in their order. Rows of equal depth
    // stay in order.
    std::vector<std::uint32_t>& keys = sort_keys_;
    keys.resize(carriers_.size());
    for (const std::uint32_t row : top_down_)
        keys[row] = std::bit_cast<std::uint32_t>(static_cast<float>(top - carriers_[row].height));
    sort_scratch_.resize(top_down_.size());
    for (int shift = 0; shift < 32; shift += 11) {
        std::array<std::uint32_t, 2049> begin{};
        for (const std::uint32_t row : top_down_) ++begin[((keys[row] >> shift) & 2047) + 1];
        for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
        for (const std::uint32_t row : top_down_) sort_scratch_[begin[(keys[row] >> shift) & 2047]++] = row;
        std::swap(top_down_, sort_scratch_);
    }
}

void KnownLoads::weigh_bodies(const Input& in, Vec3 up) {
    const Vec3d up_exact = to_double(up);
    carriers_.assign(in.motions.size(), {});
    for (const std::uint32_t body : in.awake) {
        const std::uint32_t row = in.row_of_body[body];
        carriers_[row].height = dot(in.bodies.motion[body].position, up_exact);
        const float inverse_mass = in.bodies.traits[body].inverse_mass;
        if (inverse_mass > 0)
            carriers_[row].load = std::max(-dot(in.motions[row].velocity_step, up) / inverse_mass, 0.0f);
    }
}

void KnownLoads::find_supports(const Input& in, Vec3 up, TaskRunner& tasks) {
    // Dynamic bodies that lie on their contacts; row 0 takes the contacts that carry nothing.
    supports_.resize(in.list.constraints.size());
    parallel_ranges(tasks, supports_.size(), support_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Constraint& c = in.list.constraints[i];
            const float cosine = dot(in.manifolds[c.index].normal, up);
            Support& support = supports_[i];
            support = {std::abs(cosine), 0, in.row_of_body[cosine > 0 ? c.body_a : c.body_b]};
            if (!(in.list.results[i].nearest < in.resting_gap && support.cosine > min_upward)) continue;
            const std::uint32_t row = in.row_of_body[cosine > 0 ? c.body_b : c.body_a];
            if (in.motions[row].is_dynamic) support.upper = row;
        }
    });
}

void KnownLoads::list_contacts_below() {
    std::uint32_t sum = 0;
    for (Carrier& carrier : carriers_) {
        carrier.first = sum;
        sum += carrier.end;
        carrier.end = carrier.first;
    }
    contacts_below_.resize(supports_.size());
    for (std::size_t i = 0; i < supports_.size(); ++i)
        contacts_below_[carriers_[supports_[i].upper].end++] = static_cast<std::uint32_t>(i);
}

std::span<const float> KnownLoads::find(const Input& in, TaskRunner& tasks) {
    loads_.assign(in.list.constraints.size(), 0);
    const float gravity = length(in.gravity);
    if (!(gravity > 0)) return loads_;
    const Vec3 up = in.gravity * (-1 / gravity);
    weigh_bodies(in, up);
    find_supports(in, up, tasks);
    bool any_stack = false;
    for (const Support& support : supports_) {
        carriers_[support.upper].cosines += support.cosine;
        ++carriers_[support.upper].end;
        any_stack |= support.upper != 0 && in.motions[support.lower].is_dynamic;
    }
    list_contacts_below();
    sort_top_down(any_stack);
    for (const std::uint32_t row : top_down_) {
        const Carrier& carrier = carriers_[row];
        for (std::uint32_t k = carrier.first; k < carrier.end; ++k) {
            const Support& support = supports_[contacts_below_[k]];
            const float down = carrier.load * (support.cosine / carrier.cosines);
            loads_[contacts_below_[k]] = down * support.cosine;  // friction may bear the rest: never too much
            carriers_[support.lower].load += down;
        }
    }
    return loads_;
}

}  // namespace fase::dynamics
