#pragma once
/// What the header of a shape needs: the description of its sizes, and the types in the declarations of its functions.
#include <array>
#include <concepts>
#include <cstddef>
#include <string_view>

#include "fase/core/result.hpp"
#include "fase/math/vec3.hpp"

namespace fase {

struct Aabb;
struct Pose;
struct RotatedShape;
struct TriangleMesh;
namespace detail {
struct LinearMap;
struct Solid;
}  // namespace detail

/// The allowed range of every size of a shape, in metres.
constexpr float min_shape_size = 1e-4f, max_shape_size = 1e5f;

/// Which size of a shape may be 0.
enum class ZeroSize { Refused, Allowed };

/// One size of a shape: its name and its place in the shape. A size is a length in metres in the range above, or 0
/// where that is allowed.
template <class S> class ShapeSize {
public:
    std::string_view name;  ///< as messages have it: "radius", "half.x"
    ZeroSize zero = ZeroSize::Refused;

    constexpr ShapeSize(std::string_view size_name, float S::*member, ZeroSize may_be_zero = ZeroSize::Refused)
        : name(size_name), zero(may_be_zero), number_(member) {}
    /// One coordinate of a vector of sizes.
    constexpr ShapeSize(std::string_view size_name, Vec3 S::*member, float Vec3::*coordinate)
        : name(size_name), vector_(member), coordinate_(coordinate) {}

    /// Returns the size in `shape`.
    [[nodiscard]] constexpr float& in(S& shape) const {
        return vector_ != nullptr ? shape.*vector_.*coordinate_ : shape.*number_;
    }
    [[nodiscard]] constexpr float in(const S& shape) const {
        return vector_ != nullptr ? shape.*vector_.*coordinate_ : shape.*number_;
    }

private:
    float S::*number_ = nullptr;
    Vec3 S::*vector_ = nullptr;
    float Vec3::*coordinate_ = nullptr;
};

/// A shape that its sizes describe completely. It lists them as `sizes`, in the order of snapshots and recordings; the
/// validity check, snapshots, recordings and tests loop over that list. The list may be empty.
template <class S>
concept SizedShape = requires {
    { S::sizes.size() } -> std::same_as<std::size_t>;
    requires std::same_as<typename decltype(S::sizes)::value_type, ShapeSize<S>>;
};

/// The sizes of a shape as numbers, in the order of S::sizes.
template <SizedShape S> using SizeNumbers = std::array<float, S::sizes.size()>;

template <SizedShape S> [[nodiscard]] constexpr SizeNumbers<S> size_numbers(const S& shape) {
    SizeNumbers<S> numbers{};
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = S::sizes[i].in(shape);
    return numbers;
}

/// Returns the shape with these sizes; the range is not checked (see check()).
template <SizedShape S> [[nodiscard]] constexpr S shape_with(const SizeNumbers<S>& numbers) {
    S shape;
    for (std::size_t i = 0; i < numbers.size(); ++i) S::sizes[i].in(shape) = numbers[i];
    return shape;
}

}  // namespace fase
