/// Builds all lumps first and stores them in the WAD only if all are valid.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "fase/level/bsp_lumps.hpp"
#include "fase/level/detail/little_endian.hpp"

namespace fase::level {
namespace {

using LumpBytes = std::vector<std::byte>;

std::int16_t to_i16(double value) {
    return static_cast<std::int16_t>(std::clamp(std::floor(value + 0.5), -32768.0, 32767.0));
}
std::uint32_t to_fixed(double value) {
    return static_cast<std::uint32_t>(
        static_cast<std::int32_t>(std::clamp(std::floor(value * 65536 + 0.5), -2147483648.0, 2147483647.0)));
}

/// Encodes a map's tree as lumps.
class Writer {
public:
    Writer(const Map& map, const LevelBsp& bsp, std::string where) : map_(map), bsp_(bsp), where_(std::move(where)) {
        // Drops vertices that other compilers added after those of the lines, unless a seg uses them.
        for (const Line& line : map.lines) kept_ = std::max<std::uint32_t>({kept_, line.from + 1u, line.to + 1u});
        for (const Seg& seg : bsp.segs)
            for (const std::uint32_t v : {seg.from, seg.to})
                if (v < bsp.map_vertices) kept_ = std::max(kept_, v + 1);
        cuts_ = static_cast<std::uint32_t>(bsp.vertices.size() - bsp.map_vertices);
        for (const SubSector& s : bsp.sub_sectors) add_walls(s);
    }

    Result<void> classic(std::vector<Lump>& out) const {
        if (auto fits = check_limit("vertices", kept_ + cuts_, 65536); !fits) return fits;
        if (auto fits = check_limit("segs", walls_.size(), 65535); !fits) return fits;
        if (auto fits = check_limit("sub-sectors", bsp_.sub_sectors.size(), 32768); !fits) return fits;
        LumpBytes vertices, segs, subs;
        append_vertices(vertices);
        for (std::uint32_t v = 0; v < cuts_; ++v) {
            append_i16(vertices, to_i16(cut(v).x));
            append_i16(vertices, to_i16(cut(v).y));
        }
        for (const Seg& wall : walls_) append_classic_seg(segs, wall);
        for (std::size_t s = 0; s < bsp_.sub_sectors.size(); ++s) {
            append_u16(subs, static_cast<std::uint16_t>(first_wall_[s + 1] - first_wall_[s]));
            append_u16(subs, static_cast<std::uint16_t>(first_wall_[s]));
        }
        out.push_back({"VERTEXES", std::move(vertices)});
        out.push_back({"SEGS", std::move(segs)});
        out.push_back({"SSECTORS", std::move(subs)});
        out.push_back({"NODES", nodes(false)});
        return {};
    }

    Result<void> extended(std::vector<Lump>& out, bool gl) const {
        LumpBytes vertices, sub_sectors;
        append_vertices(vertices);
        LumpBytes normal = header("XNOD");
        append_u32(normal, static_cast<std::uint32_t>(bsp_.sub_sectors.size()));
        for (std::size_t s = 0; s < bsp_.sub_sectors.size(); ++s)
            append_u32(normal, static_cast<std::uint32_t>(first_wall_[s + 1] - first_wall_[s]));
        append_u32(normal, static_cast<std::uint32_t>(walls_.size()));
        for (const Seg& wall : walls_) {
            append_u32(normal, vertex_index(wall.from));
            append_u32(normal, vertex_index(wall.to));
            append_u16(normal, static_cast<std::uint16_t>(wall.line));
            normal.push_back(std::byte{wall.left});
        }
        append_nodes(normal);
        if (gl) sub_sectors = extended_gl();
        out.push_back({"VERTEXES", std::move(vertices)});
        out.push_back({"SEGS", {}});
        out.push_back({"SSECTORS", std::move(sub_sectors)});
        out.push_back({"NODES", std::move(normal)});
        return {};
    }

    /// Returns the GL lumps, with their marker first.
    [[nodiscard]] std::vector<Lump> gl() const {
        const std::size_t edges = edges_before(bsp_.sub_sectors.size());
        const bool wide = kept_ > 32768 || cuts_ > 32768 || edges > 65534 || bsp_.sub_sectors.size() > 32768;
        LumpBytes vertices, segs, subs;
        append_text(vertices, wide ? "gNd5" : "gNd2");
        for (std::uint32_t v = 0; v < cuts_; ++v) {
            append_u32(vertices, to_fixed(cut(v).x));
            append_u32(vertices, to_fixed(cut(v).y));
        }
        std::size_t first = 0;
        const std::vector<std::uint32_t> indices = edge_indices();
        for (const SubSector& s : bsp_.sub_sectors) {
            const auto number = [&](std::size_t value) {
                wide ? append_u32(subs, static_cast<std::uint32_t>(value))
                     : append_u16(subs, static_cast<std::uint16_t>(value));
            };
            number(s.edges);
            number(first);
            first += s.edges;
            for (const Seg& seg : bsp_.edges(s)) {
                const auto put = [&](std::uint32_t value) {
                    wide ? append_u32(segs, value) : append_u16(segs, static_cast<std::uint16_t>(value));
                };
                const std::uint32_t flag = wide ? 0x80000000u : 0x8000u;
                for (const std::uint32_t v : {seg.from, seg.to})
                    put(v < bsp_.map_vertices ? v : flag | (v - static_cast<std::uint32_t>(bsp_.map_vertices)));
                append_u16(segs, static_cast<std::uint16_t>(seg.line));  // 0xffff for minisegs
                append_u16(segs, seg.left ? 1 : 0);
                put(seg.partner == no_index ? 0xffffffffu : indices[seg.partner]);
            }
        }
        return {{"GL_" + map_.name, {}},
                {"GL_VERT", std::move(vertices)},
                {"GL_SEGS", std::move(segs)},
                {"GL_SSECT", std::move(subs)},
                {"GL_NODES", nodes(wide)}};
    }

private:
    const Map& map_;
    const LevelBsp& bsp_;
    std::string where_;
    std::uint32_t kept_ = 0;  ///< number of written vertices of the map
    std::uint32_t cuts_ = 0;  ///< number of split points after them
    std::vector<Seg> walls_;  ///< without minisegs; pieces split only at neighbours' corners are joined
    std::vector<std::size_t> first_wall_{0};

    /// Adds the walls of a sub-sector; one of its own sector first, because games take the sector from it.
    void add_walls(const SubSector& s) {
        const std::size_t first = walls_.size();
        for (std::uint32_t i = s.first; i < s.first + s.edges + s.outliers; ++i) {
            const Seg& seg = bsp_.segs[i];
            if (seg.line == no_index) continue;
            const bool continues = walls_.size() > first && walls_.back().line == seg.line &&
                                   walls_.back().left == seg.left && walls_.back().to == seg.from &&
                                   i < s.first + s.edges;
            if (continues) {
                walls_.back().to = seg.to;
            } else {
                walls_.push_back(seg);
            }
        }
        const auto begin = walls_.begin() + static_cast<std::ptrdiff_t>(first);
        const auto own = std::find_if(begin, walls_.end(), [&](const Seg& seg) {
            const Line& line = map_.lines[seg.line];
            return map_.sides[seg.left ? line.left : line.right].sector == s.sector;
        });
        if (own != walls_.end()) std::rotate(begin, own, own + 1);
        first_wall_.push_back(walls_.size());
    }

    [[nodiscard]] Result<void> check_limit(std::string_view what, std::size_t found, std::size_t limit) const {
        if (found <= limit) return {};
        return Error{Status::OutOfRange, where_,
                     fmt::format("found {} {}; expected at most {} in the classic format", found, what, limit),
                     "write extended nodes"};
    }
    [[nodiscard]] Point cut(std::uint32_t v) const { return bsp_.vertices[bsp_.map_vertices + v]; }
    /// Returns the index of a vertex in a list of the map's vertices followed by the split points.
    [[nodiscard]] std::uint32_t vertex_index(std::uint32_t v) const {
        return v < bsp_.map_vertices ? v : static_cast<std::uint32_t>(v - bsp_.map_vertices + kept_);
    }
    void append_vertices(LumpBytes& out) const {
        for (std::uint32_t v = 0; v < kept_; ++v) {
            append_i16(out, map_.vertices[v].x);
            append_i16(out, map_.vertices[v].y);
        }
    }
    static void append_text(LumpBytes& out, std::string_view text) {
        for (const char c : text) out.push_back(static_cast<std::byte>(c));
    }
    void append_classic_seg(LumpBytes& out, const Seg& seg) const {
        const Line& line = map_.lines[seg.line];
        const Vertex a = map_.vertices[line.from], b = map_.vertices[line.to];
        const double sign = seg.left ? -1 : 1;
        append_u16(out, static_cast<std::uint16_t>(vertex_index(seg.from)));
        append_u16(out, static_cast<std::uint16_t>(vertex_index(seg.to)));
        append_u16(out, binary_angle(sign * (b.x - a.x), sign * (b.y - a.y)));
        append_u16(out, static_cast<std::uint16_t>(seg.line));
        append_u16(out, seg.left ? 1 : 0);
        append_u16(out, static_cast<std::uint16_t>(std::llround(seg.offset)));
    }

    LumpBytes header(std::string_view magic) const {
        LumpBytes out;
        append_text(out, magic);
        append_u32(out, kept_);
        append_u32(out, cuts_);
        for (std::uint32_t v = 0; v < cuts_; ++v) {
            append_u32(out, to_fixed(cut(v).x));
            append_u32(out, to_fixed(cut(v).y));
        }
        return out;
    }
    [[nodiscard]] LumpBytes extended_gl() const {
        LumpBytes out = header("XGLN");
        append_u32(out, static_cast<std::uint32_t>(bsp_.sub_sectors.size()));
        for (const SubSector& s : bsp_.sub_sectors) append_u32(out, s.edges);
        append_u32(out, static_cast<std::uint32_t>(edges_before(bsp_.sub_sectors.size())));
        const std::vector<std::uint32_t> indices = edge_indices();
        for (const SubSector& s : bsp_.sub_sectors) {
            for (const Seg& seg : bsp_.edges(s)) {  // each ends at the start of the next one
                append_u32(out, vertex_index(seg.from));
                append_u32(out, seg.partner == no_index ? 0xffffffffu : indices[seg.partner]);
                append_u16(out, static_cast<std::uint16_t>(seg.line));
                out.push_back(std::byte{seg.left});
            }
        }
        append_nodes(out);
        return out;
    }

    [[nodiscard]] std::size_t edges_before(std::size_t sub_sector) const {
        std::size_t count = 0;
        for (std::size_t s = 0; s < sub_sector; ++s) count += bsp_.sub_sectors[s].edges;
        return count;
    }
    /// Returns the index of each seg in a list without outliers.
    [[nodiscard]] std::vector<std::uint32_t> edge_indices() const {
        std::vector<std::uint32_t> indices(bsp_.segs.size(), no_index);
        std::uint32_t next = 0;
        for (const SubSector& s : bsp_.sub_sectors)
            for (std::uint32_t i = s.first; i < s.first + s.edges; ++i) indices[i] = next++;
        return indices;
    }

    /// Shortens directions that do not fit 16 bits, by a common divisor if there is one.
    static void append_line(LumpBytes& out, const Node& node) {
        std::int32_t dx = node.dx, dy = node.dy;
        const auto too_long = [&] { return std::max(std::abs(dx), std::abs(dy)) > 32767; };
        if (const std::int32_t common = std::gcd(dx, dy); too_long() && common > 1) {
            dx /= common;
            dy /= common;
        }
        if (too_long()) {
            dx /= 2;
            dy /= 2;
        }
        for (const std::int32_t value : {node.x, node.y, dx, dy}) append_i16(out, static_cast<std::int16_t>(value));
        for (const PlanBox& box : node.boxes)
            for (const double value :
                 {std::ceil(box.hi.y), std::floor(box.lo.y), std::floor(box.lo.x), std::ceil(box.hi.x)})
                append_i16(out, to_i16(value));
    }
    [[nodiscard]] LumpBytes nodes(bool wide) const {
        LumpBytes out;
        for (const Node& node : bsp_.nodes) {
            append_line(out, node);
            for (const std::uint32_t child : node.children) {
                if (wide) {
                    append_u32(out, child);
                } else {
                    append_u16(out, static_cast<std::uint16_t>((child & 0x7fff) |
                                                               ((child & Node::leaf_bit) != 0 ? 0x8000u : 0u)));
                }
            }
        }
        return out;
    }
    void append_nodes(LumpBytes& out) const {
        append_u32(out, static_cast<std::uint32_t>(bsp_.nodes.size()));
        const LumpBytes all = nodes(true);
        out.insert(out.end(), all.begin(), all.end());
    }
};

bool is_gl_lump(std::string_view name) {
    return name == "GL_VERT" || name == "GL_SEGS" || name == "GL_SSECT" || name == "GL_NODES" || name == "GL_PVS";
}

/// Sorts the map's lumps into the order of the format: old programs find them by position.
void sort_map_lumps(Wad& wad, std::size_t marker) {
    const auto first = wad.lumps.begin() + static_cast<std::ptrdiff_t>(marker + 1);
    const auto place = [](const Lump& lump) {
        std::string name = lump.name;
        for (char& c : name) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
        return std::find(map_lump_names.begin(), map_lump_names.end(), name) - map_lump_names.begin();
    };
    std::stable_sort(first, first + static_cast<std::ptrdiff_t>(wad.lumps_of_map(marker)),
                     [&](const Lump& a, const Lump& b) { return place(a) < place(b); });
}

}  // namespace

Result<void> write_bsp(Wad& wad, std::size_t marker, const std::string& file, const Map& map, const LevelBsp& bsp,
                       const LumpOptions& options) {
    const Writer writer(map, bsp, fmt::format("{}: {}", file, map.name));
    std::vector<Lump> lumps;
    const Result<void> made = options.extended ? writer.extended(lumps, options.gl) : writer.classic(lumps);
    if (!made) return made;
    for (Lump& lump : lumps) wad.set_in_map(marker, lump.name, std::move(lump.bytes));
    const std::size_t reject_bytes = (map.sectors.size() * map.sectors.size() + 7) / 8;
    const auto reject = wad.find_in_map(marker, "REJECT");
    if (!reject || wad.lumps[*reject].bytes.size() < reject_bytes)
        wad.set_in_map(marker, "REJECT", LumpBytes(reject_bytes, std::byte{0}));
    const auto blockmap = wad.find_in_map(marker, "BLOCKMAP");
    if (!blockmap || wad.lumps[*blockmap].bytes.empty()) wad.set_in_map(marker, "BLOCKMAP", make_blockmap(map));
    sort_map_lumps(wad, marker);

    const auto after_map = wad.lumps.begin() + static_cast<std::ptrdiff_t>(marker + 1 + wad.lumps_of_map(marker));
    auto end = after_map;
    if (end != wad.lumps.end() && end->name.starts_with("GL_") && !is_gl_lump(end->name)) {
        do ++end;
        while (end != wad.lumps.end() && is_gl_lump(end->name));
    }
    const auto place = wad.lumps.erase(after_map, end);
    if (options.gl && !options.extended) {
        std::vector<Lump> gl = writer.gl();
        wad.lumps.insert(place, std::make_move_iterator(gl.begin()), std::make_move_iterator(gl.end()));
    }
    return {};
}

std::uint16_t binary_angle(double dx, double dy) {
    // Reduces the angle to an eighth of a turn and uses a series of the arc tangent, because atan2 of the C library is
    // not the same everywhere.
    const double x = std::abs(dx), y = std::abs(dy), longer = std::max(x, y);
    if (longer == 0) return 0;
    double t = std::min(x, y) / longer;
    t = t / (1 + std::sqrt(1 + t * t));  // tangent of half the angle: below 0.4143, which keeps the series short
    t = t / (1 + std::sqrt(1 + t * t));  // halved again: below 0.199
    const double t2 = t * t;
    double sum = 0;
    for (int k = 19; k >= 1; k -= 2) sum = sum * -t2 + 1.0 / k;
    constexpr double quarter = 16384, radian = 65536 / 6.283185307179586;
    double angle = 4 * sum * t * radian;
    if (y > x) angle = quarter - angle;
    if (dx < 0) angle = 2 * quarter - angle;
    if (dy < 0) angle = -angle;
    return static_cast<std::uint16_t>(static_cast<std::int32_t>(std::floor(angle + 0.5)));
}

}  // namespace fase::level
