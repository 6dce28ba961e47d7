/// Reads lumps of all formats into one form and checks every index.
#include <fmt/format.h>

#include <cmath>

#include "fase/core/detail/text.hpp"
#include "fase/level/bsp_lumps.hpp"
#include "fase/level/detail/little_endian.hpp"

namespace fase::level {
namespace {

using Bytes = std::span<const std::byte>;

/// Reads numbers sequentially; after the end, all are 0 and failed() is true.
class Cursor {
public:
    explicit Cursor(Bytes bytes) : bytes_(bytes) {}
    std::uint32_t number(std::size_t size) {
        if (bytes_.size() - at_ < size) {
            failed_ = true;
            return 0;
        }
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < size; ++i) value |= std::to_integer<std::uint32_t>(bytes_[at_ + i]) << 8 * i;
        at_ += size;
        return value;
    }
    std::int16_t i16() { return static_cast<std::int16_t>(number(2)); }
    double fixed() { return static_cast<std::int32_t>(number(4)) / 65536.0; }
    [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }
    [[nodiscard]] std::size_t at() const { return at_; }
    [[nodiscard]] bool failed() const { return failed_; }

private:
    Bytes bytes_;
    std::size_t at_ = 0;
    bool failed_ = false;
};

/// Reads one tree; keeps the first error.
class TreeReader {
public:
    TreeReader(const std::string& file, const Wad& wad, std::size_t marker, const Map& map)
        : wad_(wad), marker_(marker), map_(map), where_(fmt::format("{}: {}", file, map.name)) {
        for (const Vertex v : map.vertices) out_.vertices.push_back({double(v.x), double(v.y)});
        out_.map_vertices = map.vertices.size();
    }

    Result<LevelBsp> read(BspLumps which) {
        const bool gl = which == BspLumps::Gl;
        const std::string_view extended = gl ? "SSECTORS" : "NODES";
        const auto lump = wad_.find_in_map(marker_, extended);
        // Classic nodes may begin with the same letters, which are coordinates there; extended ones come with no segs.
        const std::string magic = lump && is_empty("SEGS") ? magic_of(wad_.lumps[*lump].bytes) : "";
        if (magic == (gl ? "XGLN" : "XNOD")) {
            read_extended(extended, wad_.lumps[*lump].bytes, gl);
        } else if (magic == "ZNOD" || magic == "ZGLN" || magic == "XGL2" || magic == "XGL3") {
            return Error{Status::Unsupported,
                         fmt::format("{} {}", where_, extended),
                         fmt::format("found nodes of the kind {}; expected classic nodes, XNOD or XGLN", magic),
                         {}};
        } else if (gl) {
            read_gl();
        } else {
            read_classic();
        }
        if (!error_) check();
        if (error_) return *error_;
        count_stats();
        return std::move(out_);
    }

private:
    const Wad& wad_;
    std::size_t marker_;
    const Map& map_;
    std::string where_;
    LevelBsp out_;
    std::optional<Error> error_;

    [[nodiscard]] bool is_empty(std::string_view name) const {
        const auto lump = wad_.find_in_map(marker_, name);
        return !lump || wad_.lumps[*lump].bytes.empty();
    }
    static std::string magic_of(Bytes bytes) {
        std::string magic;
        for (std::size_t i = 0; i < 4 && i < bytes.size(); ++i) magic += static_cast<char>(bytes[i]);
        return magic;
    }
    void fail(std::string_view place, std::string problem) {
        if (!error_) error_ = Error{Status::Format, fmt::format("{} {}", where_, place), std::move(problem), {}};
    }
    /// Calls read(cursor) for each entry of a lump, `size` bytes each.
    template <class Read>
    void each(std::string_view name, std::optional<std::size_t> lump, std::size_t size, Read&& read) {
        if (error_) return;
        if (!lump) return fail(name, "no such lump; expected one");
        const Bytes bytes = wad_.lumps[*lump].bytes;
        if (bytes.size() % size != 0)
            return fail(name, fmt::format("found {} bytes; expected a multiple of {}", bytes.size(), size));
        for (Cursor in(bytes); in.left() > 0;) read(in);
    }

    void read_node(Cursor& in, bool wide) {
        Node& node = out_.nodes.emplace_back();
        for (std::int32_t* value : {&node.x, &node.y, &node.dx, &node.dy}) *value = in.i16();
        for (PlanBox& box : node.boxes) {
            box.hi.y = in.i16();
            box.lo.y = in.i16();
            box.lo.x = in.i16();
            box.hi.x = in.i16();
        }
        for (std::uint32_t& child : node.children) {
            child = in.number(wide ? 4 : 2);
            if (!wide && (child & 0x8000) != 0) child = Node::leaf_bit | (child & 0x7fff);
        }
    }
    void read_sub_sector(Cursor& in, std::size_t size, bool gl) {
        SubSector& s = out_.sub_sectors.emplace_back();
        (gl ? s.edges : s.outliers) = in.number(size);
        s.first = in.number(size);
    }

    void read_classic() {
        each("SEGS", wad_.find_in_map(marker_, "SEGS"), 12, [&](Cursor& in) {
            Seg& seg = out_.segs.emplace_back();
            seg.from = in.number(2);
            seg.to = in.number(2);
            in.number(2);  // the angle: follows from the line
            seg.line = in.number(2);
            seg.left = in.number(2) != 0;
            seg.offset = in.number(2);
        });
        each("SSECTORS", wad_.find_in_map(marker_, "SSECTORS"), 4, [&](Cursor& in) { read_sub_sector(in, 2, false); });
        each("NODES", wad_.find_in_map(marker_, "NODES"), 28, [&](Cursor& in) { read_node(in, false); });
    }

    [[nodiscard]] std::optional<std::size_t> gl_lump(std::size_t gl_marker, std::string_view name) const {
        for (std::size_t i = gl_marker + 1; i < wad_.lumps.size() && i <= gl_marker + 5; ++i)
            if (wad_.lumps[i].name == name) return i;
        return std::nullopt;
    }
    void read_gl() {
        const std::size_t gl_marker = marker_ + 1 + wad_.lumps_of_map(marker_);
        if (gl_marker >= wad_.lumps.size() || wad_.lumps[gl_marker].name != "GL_" + map_.name)
            return fail("GL nodes", fmt::format("no lump GL_{} after the map; expected one", map_.name));
        const auto vertices = gl_lump(gl_marker, "GL_VERT");
        if (!vertices) return fail("GL_VERT", "no such lump; expected one");
        const Bytes bytes = wad_.lumps[*vertices].bytes;
        const std::string magic = magic_of(bytes);
        if (magic != "gNd2" && magic != "gNd5")
            return fail("GL_VERT", "found GL nodes of another version; expected 2 or 5");
        if (bytes.size() % 8 != 4)
            return fail("GL_VERT", fmt::format("found {} bytes; expected 4, and 8 per vertex", bytes.size()));
        for (Cursor in(bytes.subspan(4)); in.left() > 0;) {
            const double x = in.fixed();
            out_.vertices.push_back({x, in.fixed()});
        }
        const bool wide = magic == "gNd5";
        const std::size_t size = wide ? 4 : 2;
        const std::uint32_t flag = wide ? 0x80000000u : 0x8000u, none = wide ? 0xffffffffu : 0xffffu;
        each("GL_SEGS", gl_lump(gl_marker, "GL_SEGS"), 4 + 3 * size, [&](Cursor& in) {
            Seg& seg = out_.segs.emplace_back();
            for (std::uint32_t* v : {&seg.from, &seg.to}) {
                *v = in.number(size);
                if ((*v & flag) != 0) *v = (*v & ~flag) + static_cast<std::uint32_t>(out_.map_vertices);
            }
            const std::uint32_t line = in.number(2);
            seg.line = line == 0xffff ? no_index : line;
            seg.left = in.number(2) != 0 && seg.line != no_index;
            seg.partner = in.number(size);
            if (seg.partner == none) seg.partner = no_index;
        });
        each("GL_SSECT", gl_lump(gl_marker, "GL_SSECT"), 2 * size,
             [&](Cursor& in) { read_sub_sector(in, size, true); });
        each("GL_NODES", gl_lump(gl_marker, "GL_NODES"), 24 + 2 * size, [&](Cursor& in) { read_node(in, wide); });
    }

    /// Returns whether `count` entries of `size` bytes are left; fails if not.
    bool holds(std::string_view lump, const Cursor& in, std::size_t count, std::size_t size, std::string_view what) {
        if (!error_ && (in.failed() || count > in.left() / size))
            fail(detail::at_byte(lump, in.at()),
                 fmt::format("found {} {}; expected them inside the lump ({} bytes left)", count, what, in.left()));
        return !error_;
    }
    void read_extended(std::string_view lump, Bytes bytes, bool gl) {
        Cursor in(bytes.subspan(4));
        const std::uint32_t of_map = in.number(4), cuts = in.number(4);
        if (of_map > out_.vertices.size())
            return fail(lump,
                        fmt::format("found {} vertices of the map; expected at most {}", of_map, out_.vertices.size()));
        out_.vertices.resize(of_map);
        out_.map_vertices = of_map;
        if (!holds(lump, in, cuts, 8, "vertices")) return;
        for (std::uint32_t v = 0; v < cuts; ++v) {
            const double x = in.fixed();
            out_.vertices.push_back({x, in.fixed()});
        }
        const std::uint32_t subs = in.number(4);
        if (!holds(lump, in, subs, 4, "sub-sectors")) return;
        std::uint32_t first = 0;
        for (std::uint32_t s = 0; s < subs; ++s) {
            SubSector& placed = out_.sub_sectors.emplace_back();
            const std::uint32_t size = in.number(4);
            (gl ? placed.edges : placed.outliers) = size;
            placed.first = first;
            first += size;
        }
        const std::uint32_t segs = in.number(4);
        if (!holds(lump, in, segs, 11, "segs")) return;
        for (std::uint32_t i = 0; i < segs; ++i) {
            Seg& seg = out_.segs.emplace_back();
            seg.from = in.number(4);
            (gl ? seg.partner : seg.to) = in.number(4);
            const std::uint32_t line = in.number(2);
            seg.line = line == 0xffff && gl ? no_index : line;
            seg.left = in.number(1) != 0 && seg.line != no_index;
        }
        const std::uint32_t nodes = in.number(4);
        if (!holds(lump, in, nodes, 32, "nodes")) return;
        for (std::uint32_t n = 0; n < nodes; ++n) read_node(in, true);
        if (!gl) return;
        for (const SubSector& s : out_.sub_sectors) {
            if (s.first + std::uint64_t{s.edges} > segs) return;  // check() reports it
            for (std::uint32_t i = 0; i < s.edges; ++i)
                out_.segs[s.first + i].to = out_.segs[s.first + (i + 1) % s.edges].from;
        }
    }

    void check_index(std::string_view kind, std::size_t entry, std::string_view what, std::size_t index,
                     std::size_t count) {
        if (index >= count && !error_)
            fail(fmt::format("{}[{}]", kind, entry),
                 fmt::format("found {} {}; expected one of the {}", what, index, count));
    }
    void check() {
        if (out_.sub_sectors.empty()) return fail("sub-sectors", "found none; expected at least one");
        for (std::size_t i = 0; i < out_.segs.size() && !error_; ++i) {
            const Seg& seg = out_.segs[i];
            check_index("segs", i, "vertex", seg.from, out_.vertices.size());
            check_index("segs", i, "vertex", seg.to, out_.vertices.size());
            if (seg.partner != no_index) check_index("segs", i, "partner", seg.partner, out_.segs.size());
            if (seg.line == no_index) continue;
            check_index("segs", i, "line", seg.line, map_.lines.size());
            if (error_) return;
            const Line& line = map_.lines[seg.line];
            if ((seg.left ? line.left : line.right) == no_side)
                fail(fmt::format("segs[{}]", i), fmt::format("found a side that line {} does not have", seg.line));
        }
        if (!error_) check_ranges();
        if (!error_) check_tree();
    }
    void check_ranges() {
        std::vector<std::uint8_t> used(out_.segs.size());
        for (std::size_t s = 0; s < out_.sub_sectors.size(); ++s) {
            SubSector& placed = out_.sub_sectors[s];
            const std::uint64_t size = std::uint64_t{placed.edges} + placed.outliers;
            if (placed.first + size > out_.segs.size()) {
                return fail(fmt::format("sub-sectors[{}]", s),
                            fmt::format("found segs {} to {}; expected them among the {}", placed.first,
                                        placed.first + size, out_.segs.size()));
            }
            if (size == 0) return fail(fmt::format("sub-sectors[{}]", s), "found no segs; expected at least one");
            for (std::uint64_t i = placed.first; i < placed.first + size; ++i) {
                if (used[i] != 0)
                    return fail(fmt::format("sub-sectors[{}]", s),
                                fmt::format("found seg {}, which another sub-sector contains too", i));
                used[i] = 1;
                Seg& seg = out_.segs[i];
                seg.sub_sector = static_cast<std::uint32_t>(s);
            }
            for (std::uint64_t i = placed.first; i < placed.first + size; ++i) {
                const Seg& seg = out_.segs[i];
                if (seg.line == no_index) continue;
                const Line& line = map_.lines[seg.line];
                placed.sector = map_.sides[seg.left ? line.left : line.right].sector;
                break;
            }
        }
    }
    /// Checks that each node and sub-sector is a child exactly once and is reached from the root.
    void check_tree() {
        std::vector<std::uint8_t> node_seen(out_.nodes.size()), leaf_seen(out_.sub_sectors.size());
        std::vector<std::uint32_t> stack{out_.root()};
        std::size_t seen = 0;
        while (!stack.empty()) {
            const std::uint32_t child = stack.back(), index = child & ~Node::leaf_bit;
            stack.pop_back();
            const bool is_leaf = (child & Node::leaf_bit) != 0;
            std::vector<std::uint8_t>& marks = is_leaf ? leaf_seen : node_seen;
            if (index >= marks.size() || marks[index] != 0) {
                return fail("nodes", fmt::format("found {} {} as a child {}; expected each of the {} once",
                                                 is_leaf ? "sub-sector" : "node", index,
                                                 index < marks.size() ? "twice" : "that does not exist", marks.size()));
            }
            marks[index] = 1;
            ++seen;
            if (is_leaf) continue;
            if (out_.nodes[index].dx == 0 && out_.nodes[index].dy == 0)
                return fail(fmt::format("nodes[{}]", index), "found a partition line without a direction");
            for (const std::uint32_t next : out_.nodes[index].children) stack.push_back(next);
        }
        if (seen != out_.nodes.size() + out_.sub_sectors.size())
            fail("nodes", fmt::format("found {} nodes and sub-sectors below the root; expected all {}", seen,
                                      out_.nodes.size() + out_.sub_sectors.size()));
    }
    void count_stats() {
        BspStats& stats = out_.stats;
        for (const Line& line : map_.lines) {
            ++stats.lines;
            stats.sides += (line.right != no_side ? 1u : 0u) + (line.left != no_side ? 1u : 0u);
        }
        for (const Seg& seg : out_.segs) ++(seg.line == no_index ? stats.minisegs : stats.wall_segs);
        stats.splits = stats.wall_segs > stats.sides ? stats.wall_segs - stats.sides : 0;
        stats.worst_depth = 0;
        std::vector<std::pair<std::uint32_t, std::size_t>> stack{{out_.root(), 0}};
        std::size_t sum = 0;
        while (!stack.empty()) {
            const auto [child, depth] = stack.back();
            stack.pop_back();
            if ((child & Node::leaf_bit) != 0) {
                sum += depth;
                stats.worst_depth = std::max(stats.worst_depth, depth);
                continue;
            }
            for (const std::uint32_t next : out_.nodes[child].children) stack.emplace_back(next, depth + 1);
        }
        stats.mean_depth = static_cast<double>(sum) / static_cast<double>(out_.sub_sectors.size());
    }
};

}  // namespace

Result<LevelBsp> read_bsp(const std::string& file, const Wad& wad, std::size_t marker, const Map& map, BspLumps which) {
    return TreeReader(file, wad, marker, map).read(which);
}

}  // namespace fase::level
