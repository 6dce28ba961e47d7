#pragma once
/// Stones and how they are laid: courses of blocks, rings of wedges, an arch.
#include <array>
#include <vector>

#include "fase/scene/generate/builder.hpp"

namespace fase::scene {

/// What a mason has at hand. Stones of one course stand `joint` apart; courses lie on each other without a gap.
struct Masonry {
    Builder& builder;
    Random random;
    static constexpr float joint = 0.0005f;  ///< metres
    static constexpr float course = 0.5f;    ///< height of a course
    static constexpr float length = 1;       ///< of a block with its joint
};

/// Where a straight wall runs: from `start` (middle of its end face, ground level) along a unit direction that lies in
/// the ground.
struct WallLine {
    Vec3d start;
    Vec3 along{1, 0, 0};
};

/// One size of block: its full and its half length.
struct BlockKind {
    std::uint32_t full = 0, half = 0;
    float depth = 0;
};
[[nodiscard]] BlockKind make_blocks(Masonry& masonry, float depth);

/// Lays `courses` courses of `blocks` blocks in running bond, from course number `first` on (which tells how the bond
/// begins). `offset` moves the wall sideways, to the left of its direction.
void lay_wall(Masonry& masonry, const BlockKind& kind, const WallLine& line, float offset, int blocks, int first,
              int courses);

/// Every second of `blocks` blocks: battlements at height `y`.
void lay_battlement(Masonry& masonry, std::uint32_t merlon, float half_height, const WallLine& line, float offset,
                    int blocks, double y);

/// A round tower of wedge stones with a wooden floor on top and battlements; `roofed`: with a cone on those.
void build_tower(Masonry& masonry, Vec3d foot, float outer, int courses, bool roofed);

/// A square tower laid course over course the other way around, roofed with beams, with battlements.
void build_keep(Masonry& masonry, Vec3d foot, int blocks, int courses);

/// The stones of an arch of inner radius `radius` that fill the rectangle from -half_width to half_width and from 0 to
/// `height`, `depth` thick (along the line's left). Stands with its springing at `middle`.
void build_arch(Masonry& masonry, Vec3d middle, Vec3 along, float radius, float half_width, float height, float depth);

/// The stone's colour: one of a few close tones.
[[nodiscard]] Stuff stone_of(Masonry& masonry, std::string_view name);
/// Turns x to `along`, which lies in the ground.
[[nodiscard]] Quat facing(Vec3 along);

inline constexpr Stuff wood{"beam", {0.36f, 0.22f, 0.12f}, 700, {.friction = 0.6f}};
inline constexpr Stuff tiles{"roof", {0.48f, 0.16f, 0.10f}, 500, {.friction = 0.6f}};
inline constexpr Stuff iron{"ball", {0.06f, 0.06f, 0.07f}, 7800, {.friction = 0.5f}};

}  // namespace fase::scene
