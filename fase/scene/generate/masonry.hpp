#pragma once
/// Builds masonry from loose stones: walls of blocks, towers of wedges, an arch.
#include <array>
#include <vector>

#include "fase/scene/generate/builder.hpp"

namespace fase::scene {

/// Context of all masonry functions. Stones of one course are `joint` apart; courses rest on each other without a gap.
struct Masonry {
    Builder& builder;
    Random random;
    static constexpr float joint = 0.0005f;  ///< metres
    static constexpr float course = 0.5f;    ///< height of a course
    static constexpr float length = 1;       ///< of a block including its joint
};

/// The line of a straight wall: from `start` (middle of its end face, at ground level) along a horizontal unit vector.
struct WallLine {
    Vec3d start;
    Vec3 along{1, 0, 0};
};

/// Blocks of one depth: shapes of full and of half length.
struct BlockKind {
    std::uint32_t full = 0, half = 0;
    float depth = 0;
};
/// Adds the shapes of blocks of one depth.
[[nodiscard]] BlockKind make_blocks(Masonry& masonry, float depth);

/// Adds `courses` courses of `blocks` blocks in running bond, from course number `first` on; odd courses start with a
/// half block. `offset` moves the wall to the left of its direction.
void add_wall_courses(Masonry& masonry, const BlockKind& kind, const WallLine& line, float offset, int blocks,
                      int first, int courses);

/// Adds battlements at height `y`: every second one of `blocks` blocks.
void add_battlement(Masonry& masonry, std::uint32_t merlon, float half_height, const WallLine& line, float offset,
                    int blocks, double y);

/// Adds a round tower of wedge stones with a wooden deck and battlements; `roofed`: and a cone as its roof.
void build_tower(Masonry& masonry, Vec3d foot, float outer, int courses, bool roofed);

/// Adds a square tower whose courses alternate in direction, with a roof of beams and battlements.
void build_keep(Masonry& masonry, Vec3d foot, int blocks, int courses);

/// Adds the stones of an arch of inner radius `radius`. They fill the rectangle from -half_width to half_width and from
/// 0 to `height`, and are `depth` thick. `middle` is the centre of the arch's base line.
void build_arch(Masonry& masonry, Vec3d middle, Vec3 along, float radius, float half_width, float height, float depth);

/// Returns the properties of a stone, with a random grey tone.
[[nodiscard]] BodyStyle stone_of(Masonry& masonry, std::string_view name);
/// Returns the rotation that turns x to the horizontal unit vector `along`.
[[nodiscard]] Quat facing(Vec3 along);

inline constexpr BodyStyle wood{"beam", {0.36f, 0.22f, 0.12f}, 700, {.friction = 0.6f}};
inline constexpr BodyStyle tiles{"roof", {0.48f, 0.16f, 0.10f}, 500, {.friction = 0.6f}};
inline constexpr BodyStyle iron{"ball", {0.06f, 0.06f, 0.07f}, 7800, {.friction = 0.5f}};

}  // namespace fase::scene
