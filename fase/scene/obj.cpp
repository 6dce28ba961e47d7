/// Parses OBJ lines into vertices and triangles.
#include "fase/scene/obj.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "fase/core/detail/file_kind.hpp"
#include "fase/core/detail/files.hpp"
#include "fase/core/detail/text.hpp"
#include "fase/scene/detail/json.hpp"

namespace fase::scene {
namespace {

constexpr std::size_t max_bytes = std::size_t{1} << 30;

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

/// Splits a text into words and lines; a `\` before a line's end counts as a blank.
class Words {
public:
    explicit Words(std::string_view text) : text_(text) {}

    /// Returns the next word of the line; empty at its end.
    std::string_view next() {
        while (position_ < text_.size() && (is_blank(text_[position_]) || continues())) {
            if (text_[position_] == '\\') {
                position_ = text_.find('\n', position_);
                ++line_;
            }
            ++position_;
        }
        const std::size_t first = position_;
        while (position_ < text_.size() && text_[position_] != '\n' && !is_blank(text_[position_]) && !continues())
            ++position_;
        return text_.substr(first, position_ - first);
    }
    /// Advances to the next line; false if there is none.
    bool next_line() {
        while (!next().empty()) {
        }
        if (position_ >= text_.size()) return false;
        ++position_;
        ++line_;
        return position_ < text_.size();
    }
    [[nodiscard]] std::size_t line() const { return line_; }

private:
    std::string_view text_;
    std::size_t position_ = 0, line_ = 1;

    [[nodiscard]] bool continues() const {
        if (text_[position_] != '\\') return false;
        const std::size_t after =
            position_ + 1 < text_.size() && text_[position_ + 1] == '\r' ? position_ + 2 : position_ + 1;
        return after < text_.size() && text_[after] == '\n';
    }
};

/// Parses the complete word.
template <class Number> bool parse_number(std::string_view word, Number& number) {
    if (!word.empty() && word.front() == '+') word.remove_prefix(1);
    const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), number);
    return problem == std::errc{} && end == word.data() + word.size();
}

/// A corner of a face, projected to a coordinate plane.
struct PlanePoint {
    double x = 0, y = 0;
};
/// Twice the signed area of a triangle; above 0: counter-clockwise.
double signed_area(PlanePoint a, PlanePoint b, PlanePoint c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Faces with more corners become fans: ear clipping is quadratic or worse.
constexpr std::size_t max_clipped_corners = 512;

/// Triangulates a face by ear clipping; a rest without an ear (the face intersects itself) becomes a fan. Modifies
/// `face`. Source: Meisters 1975, Polygons have ears.
void add_triangles(TriangleMesh& mesh, std::vector<std::uint32_t>& face) {
    Vec3d normal{};
    const auto corner = [&](std::size_t i) { return to_double(mesh.positions[face[i % face.size()]]); };
    for (std::size_t i = 0; i < face.size(); ++i) normal += cross(corner(i) - corner(0), corner(i + 1) - corner(0));
    const Vec3d size = abs(normal);
    const int axis = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
    const bool flipped = normal[axis] < 0;
    const auto projected = [&](std::size_t i) {
        const Vec3d p = corner(i);
        const PlanePoint f{p[(axis + 1) % 3], p[(axis + 2) % 3]};
        return flipped ? PlanePoint{f.y, f.x} : f;
    };
    const auto is_ear = [&](std::size_t i) {
        const PlanePoint a = projected(i), b = projected(i + 1), c = projected(i + 2);
        if (!(signed_area(a, b, c) > 0)) return false;
        for (std::size_t k = i + 3; k < i + face.size(); ++k) {
            const PlanePoint p = projected(k);
            if (signed_area(a, b, p) >= 0 && signed_area(b, c, p) >= 0 && signed_area(c, a, p) >= 0) return false;
        }
        return true;
    };
    while (face.size() > 3 && face.size() <= max_clipped_corners) {
        std::size_t ear = 0;
        while (ear < face.size() && !is_ear(ear)) ++ear;
        if (ear == face.size()) break;
        const std::size_t tip = (ear + 1) % face.size();
        mesh.indices.insert(mesh.indices.end(), {face[ear], face[tip], face[(ear + 2) % face.size()]});
        face.erase(face.begin() + static_cast<std::ptrdiff_t>(tip));
    }
    for (std::size_t i = 2; i < face.size(); ++i)
        mesh.indices.insert(mesh.indices.end(), {face[0], face[i - 1], face[i]});
}

}  // namespace

Result<TriangleMesh> parse_obj(const std::string& name, std::span<const std::byte> bytes) {
    const FileKind kind = kind_of(bytes);
    if (kind != FileKind::Obj && kind != FileKind::Other && kind != FileKind::Empty)
        return wrong_kind(name, kind, "a mesh as OBJ text");
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    TriangleMesh mesh;
    Words words(text);
    std::optional<Error> error;
    const auto fail = [&](std::string problem) {
        error = Error{Status::Format, detail::at_line(name, words.line()), std::move(problem), {}};
    };
    const auto read_corner = [&] {
        Vec3 corner;
        for (int axis = 0; axis < 3; ++axis) {
            const std::string_view word = words.next();
            double number = 0;
            if (!parse_number(word, number) || !std::isfinite(static_cast<float>(number)))
                return fail(fmt::format("found {} as a coordinate; expected a number in the range of float",
                                        word.empty() ? "nothing" : quoted_short(word)));
            corner[axis] = static_cast<float>(number);
        }
        mesh.positions.push_back(corner);
    };
    std::vector<std::uint32_t> face;
    const auto read_face = [&] {
        face.clear();
        for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
            std::int64_t number = 0;
            const auto corners = static_cast<std::int64_t>(mesh.positions.size());
            if (!parse_number(word.substr(0, word.find('/')), number))
                return fail(
                    fmt::format("found {} as a corner of a face; expected a vertex number", quoted_short(word)));
            const std::int64_t index = number > 0 ? number - 1 : corners + number;
            if (number == 0 || index < 0 || index >= corners)
                return fail(fmt::format("found corner {}; expected one of the {} before this line", number, corners));
            face.push_back(static_cast<std::uint32_t>(index));
        }
        if (face.size() < 3) return fail(fmt::format("found a face of {} corners; expected at least 3", face.size()));
        add_triangles(mesh, face);
    };
    if (const std::size_t nul = text.find('\0'); nul != std::string_view::npos)
        return Error{Status::Format, detail::at_byte(name, nul), "found a NUL byte; expected text", {}};
    if (text.empty()) return mesh;
    do {
        const std::string_view keyword = words.next();
        if (keyword == "v") read_corner();
        if (keyword == "f") read_face();
        if (error) return *std::move(error);
    } while (words.next_line());
    return mesh;
}

Result<TriangleMesh> read_obj(const std::string& path) {
    const Result<std::vector<std::byte>> bytes = read_file(path, max_bytes);
    if (!bytes) return bytes.error();
    return parse_obj(path, *bytes);
}

}  // namespace fase::scene
