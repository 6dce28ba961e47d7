/// Shapes under linear maps.
#include "fase/geometry/scaled.hpp"

#include "fase/core/detail/text.hpp"
#include "fase/geometry/detail/linear_map.hpp"
#include "fase/geometry/mass.hpp"

namespace fase {
namespace {

Error bad(std::string problem) { return {Status::BadArgument, "scale", std::move(problem), ""}; }

}  // namespace

Result<RotatedShape> transformed(const Shape& shape, const Mat3& map) {
    if (!is_finite(map.x) || !is_finite(map.y) || !is_finite(map.z)) return bad("found a number that is not finite");
    const Mat3d wide = to_double(map);
    const double size = length(wide.x) * length(wide.y) * length(wide.z);
    const double volume = determinant(wide);
    if (!(volume > 1e-12 * size || volume < -1e-12 * size)) {
        return bad(detail::format("found a determinant of {}; expected a map that keeps a volume", volume));
    }
    Result<RotatedShape> result =
        std::visit([map = detail::LinearMap(wide)](const auto& s) { return detail::image_of(s, map); }, shape);
    if (!result) return result;
    if (Result<void> fit = check(result->shape); !fit) return fit.error();
    return result;
}

Result<Shape> scaled(const Shape& shape, Vec3 scale) {
    Result<RotatedShape> image = transformed(shape, Mat3::diagonal(scale));
    if (!image) return image.error();
    if (std::holds_alternative<HalfSpace>(shape) && scale.y < 0) {
        return Error{Status::Unsupported, "scale", detail::format("a half-space with a scale of y of {}", scale.y),
                     "rotate its node instead"};
    }
    // A round shape or box that is mirrored along its own axes does not change.
    return std::move(image->shape);
}

}  // namespace fase
