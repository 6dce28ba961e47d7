/// Divides cells from the root down, each with its walls, until no line divides the walls of a cell.
#include "fase/level/bsp_compiler.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "fase/level/compiler/cut_state.hpp"
#include "fase/level/compiler/partition_choice.hpp"

namespace fase::level {
namespace {

/// A pending cell. Its pieces and corners are at the end of their stacks when it is popped.
struct Cell {
    std::uint32_t first_piece = 0, first_corner = 0;
    std::uint32_t parent = no_index;
    std::uint32_t child = 0;  ///< which of the parent's
    std::uint32_t depth = 0;
};

/// Divides convex cells and the pieces in them.
class CellDivider {
public:
    CellDivider(const CompileOptions& options, Plan&& plan, std::vector<Piece>&& pieces)
        : options_(options), pieces_(std::move(pieces)) {
        tree_.plan = std::move(plan);
        const std::uint32_t box = tree_.plan.box_planes;
        for (std::uint32_t k = 0; k < 4; ++k) {
            const ExactPoint corner = exact_meeting(tree_.plan.planes[box + (k + 3) % 4], tree_.plan.planes[box + k]);
            corners_.push_back({tree_.plan.points.index_of(corner), box + k, no_index});
        }
        cells_.push_back({});
    }

    /// Builds the tree. Returns false if there are too many pieces.
    bool run() {
        PartitionChoice choice(tree_.plan, options_);
        while (!cells_.empty()) {
            const Cell cell = cells_.back();
            cells_.pop_back();
            inside_.assign(pieces_.begin() + cell.first_piece, pieces_.end());
            outline_.assign(corners_.begin() + cell.first_corner, corners_.end());
            pieces_.resize(cell.first_piece);
            corners_.resize(cell.first_corner);
            const std::uint32_t plane = choice.choose(inside_, cell.depth);
            const bool is_leaf = plane == no_index;
            const auto index = static_cast<std::uint32_t>(is_leaf ? tree_.leaves.size() : tree_.nodes.size());
            if (cell.parent != no_index)
                tree_.nodes[cell.parent].children[cell.child] = is_leaf ? Node::leaf_bit | index : index;
            if (is_leaf) {
                add_leaf(cell.depth);
            } else {
                tree_.nodes.push_back({plane, {0, 0}});
                divide(plane, index, cell.depth);
            }
            if (pieces_.size() + tree_.pieces.size() > options_.max_pieces) return false;
        }
        return true;
    }
    RawTree&& release() { return std::move(tree_); }

private:
    const CompileOptions& options_;
    RawTree tree_;
    std::vector<Cell> cells_;
    std::vector<Piece> pieces_, inside_, right_pieces_;
    std::vector<CellCorner> corners_, outline_, clipped_outline_;

    /// Pushes the left part of the current cell, then the right part.
    void divide(std::uint32_t plane, std::uint32_t node, std::uint32_t depth) {
        for (const int child : {1, 0}) {
            cells_.push_back({static_cast<std::uint32_t>(pieces_.size()), static_cast<std::uint32_t>(corners_.size()),
                              node, static_cast<std::uint32_t>(child), depth + 1});
            clip_outline(plane, node, child == 0, corners_);
            if (child == 1) {
                divide_pieces(plane);
            } else {
                pieces_.insert(pieces_.end(), right_pieces_.begin(), right_pieces_.end());
            }
        }
    }

    /// Pushes left pieces on the stack; stores right pieces in `right_pieces_`.
    void divide_pieces(std::uint32_t plane) {
        Plan& plan = tree_.plan;
        const ExactLine line = plan.planes[plane];
        right_pieces_.clear();
        for (const Piece& piece : inside_) {
            if (plan.plane_of_line[piece.line] == plane) {
                if (const std::uint8_t sides = plan.sides_right(piece))
                    right_pieces_.push_back({piece.a, piece.b, piece.line, sides});
                if (const std::uint8_t sides = plan.sides_left(piece))
                    pieces_.push_back({piece.a, piece.b, piece.line, sides});
                continue;
            }
            const int a = plan.points.side(line, piece.a), b = plan.points.side(line, piece.b);
            if (a <= 0 && b <= 0) {
                right_pieces_.push_back(piece);
            } else if (a >= 0 && b >= 0) {
                pieces_.push_back(piece);
            } else {
                const std::uint32_t crossing =
                    plan.points.index_of(exact_meeting(line, plan.planes[plan.plane_of_line[piece.line]]));
                const Piece first{piece.a, crossing, piece.line, piece.sides},
                    second{crossing, piece.b, piece.line, piece.sides};
                right_pieces_.push_back(a < 0 ? first : second);
                pieces_.push_back(a < 0 ? second : first);
            }
        }
    }

    /// Appends the part of the current outline on one side of a plane; `node` is the node of the new edge.
    void clip_outline(std::uint32_t plane, std::uint32_t node, bool right, std::vector<CellCorner>& out) {
        Plan& plan = tree_.plan;
        const ExactLine line = plan.planes[plane];
        const int keep = right ? -1 : 1;
        const std::size_t count = outline_.size();
        int side = plan.points.side(line, outline_[0].point) * keep;
        for (std::size_t i = 0; i < count; ++i) {
            const CellCorner& corner = outline_[i];
            const int next = plan.points.side(line, outline_[i + 1 < count ? i + 1 : 0].point) * keep;
            if (side > 0 || (side == 0 && next > 0)) {
                out.push_back(corner);
            } else if (side == 0 && next < 0) {
                out.push_back({corner.point, plane, node});  // the outline crosses to the other side
            }
            if (side * next < 0) {
                const std::uint32_t crossing = plan.points.index_of(exact_meeting(line, plan.planes[corner.plane]));
                out.push_back(side < 0 ? CellCorner{crossing, corner.plane, corner.node}
                                       : CellCorner{crossing, plane, node});
            }
            side = next;
        }
    }

    /// Adds a leaf; clips its cell by its walls.
    void add_leaf(std::uint32_t depth) {
        const Plan& plan = tree_.plan;
        for (const Piece& piece : inside_) {
            const std::uint32_t plane = plan.plane_of_line[piece.line];
            const bool known =
                std::any_of(outline_.begin(), outline_.end(), [&](const CellCorner& c) { return c.plane == plane; });
            if (known) continue;
            clipped_outline_.clear();
            clip_outline(plane, no_index, plan.sides_right(piece) != 0, clipped_outline_);
            outline_.swap(clipped_outline_);
        }
        tree_.leaves.push_back(
            {static_cast<std::uint32_t>(tree_.pieces.size()), static_cast<std::uint32_t>(inside_.size()),
             static_cast<std::uint32_t>(tree_.corners.size()), static_cast<std::uint32_t>(outline_.size()), depth});
        tree_.pieces.insert(tree_.pieces.end(), inside_.begin(), inside_.end());
        tree_.corners.insert(tree_.corners.end(), outline_.begin(), outline_.end());
    }
};

Result<void> check(const Map& map) {
    const auto refuse = [](std::size_t line, std::string_view what) {
        return Error{Status::BadArgument,
                     fmt::format("lines[{}]", line),
                     fmt::format("found a {} that does not exist; expected one that the map has", what),
                     {}};
    };
    bool any = false;
    for (std::size_t i = 0; i < map.lines.size(); ++i) {
        const Line& line = map.lines[i];
        if (line.from >= map.vertices.size() || line.to >= map.vertices.size()) return refuse(i, "vertex");
        for (const std::uint16_t side : {line.right, line.left}) {
            if (side == no_side) continue;
            if (side >= map.sides.size()) return refuse(i, "side");
            if (map.sides[side].sector >= map.sectors.size()) return refuse(i, "side of a sector");
            any |= map.vertices[line.from] != map.vertices[line.to];
        }
    }
    if (any) return {};
    return Error{Status::BadArgument, "lines", "found no line with a length and a side; expected at least one", {}};
}

}  // namespace

Result<LevelBsp> compile(const Map& map, const CompileOptions& options) {
    if (auto good = check(map); !good) return good.error();
    std::vector<Piece> pieces;
    Plan plan = make_plan(map, pieces);
    CellDivider divider(options, std::move(plan), std::move(pieces));
    if (!divider.run()) {
        return Error{Status::Capacity,
                     "lines",
                     fmt::format("found more than {} pieces of lines that cross; expected fewer", options.max_pieces),
                     {}};
    }
    return lay_out(map, divider.release());
}

}  // namespace fase::level
