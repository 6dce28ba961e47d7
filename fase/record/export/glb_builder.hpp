#pragma once
/// Builds a binary glTF file from JSON and typed arrays of numbers.
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "fase/core/result.hpp"
#include "fase/math/pose.hpp"
#include "fase/record/recording/bytes.hpp"
#include "fase/record/tables.hpp"

namespace fase::record {

/// Collects numbers in one buffer, grouped by use; stores equal arrays of times once. Source: Khronos Group 2021,
/// glTF 2.0 specification, 3.6 and 4.
class GlbBuilder {
public:
    // Each function returns the index of its accessor.
    std::uint32_t add_times(std::span<const float> seconds);
    std::uint32_t add_points(std::span<const Vec3> points) { return add_vectors(Use::Motion, points); }
    std::uint32_t add_rotations(std::span<const Quat> rotations);
    std::uint32_t add_positions(std::span<const Vec3> vertices) { return add_vectors(Use::Positions, vertices); }
    std::uint32_t add_normals(std::span<const Vec3> normals) { return add_vectors(Use::Normals, normals); }
    std::uint32_t add_indices(std::span<const Triangle> triangles);

    /// Returns the complete file. Error Capacity if it exceeds 4 GiB.
    /// @param document a non-empty JSON object with everything except buffers, buffer views and accessors
    Result<std::vector<std::byte>> finish(std::string document);

private:
    enum class Use : std::size_t { Times, Motion, Positions, Normals, Indices, Count };
    struct Accessor {
        Use use;
        std::size_t begin, count;
        int component;
        const char* type;
        std::vector<float> min, max;  ///< of each component; empty where glTF does not require them
    };
    std::uint32_t add_vectors(Use use, std::span<const Vec3> vectors);
    std::uint32_t add_accessor(Use use, std::size_t begin, std::size_t count, int component, const char* type);
    ByteWriter& data(Use use) { return data_[static_cast<std::size_t>(use)]; }

    std::array<ByteWriter, static_cast<std::size_t>(Use::Count)> data_;
    std::vector<Accessor> accessors_;
    std::unordered_map<std::string, std::uint32_t> times_;  ///< accessors of times, by their bytes
};

}  // namespace fase::record
