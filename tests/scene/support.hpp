#pragma once
/// Shared by the tests of scenes: fixtures, files from text, lookup of bodies by name.
#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "fase/scene/gltf.hpp"

namespace fase::scene::test {

inline std::string fixture(std::string_view name) { return std::string(FASE_DATA) + "/gltf/" + std::string(name); }

inline std::vector<std::byte> bytes_of(std::string_view text) {
    const auto* begin = reinterpret_cast<const std::byte*>(text.data());
    return {begin, begin + text.size()};
}

inline std::string content_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

/// A temporary folder; the destructor removes it.
class TemporaryFolder {
public:
    TemporaryFolder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "fase-test-XXXXXX").string();
        path_ = mkdtemp(pattern.data());
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder() { std::filesystem::remove_all(path_); }
    [[nodiscard]] std::string operator/(std::string_view name) const { return (path_ / name).string(); }
    [[nodiscard]] std::string path() const { return path_.string(); }

private:
    std::filesystem::path path_;
};

inline void write_text(const std::string& path, std::string_view text) {
    std::ofstream(path, std::ios::binary) << text;
}

/// Reads a glTF text like a file in `folder`.
inline Result<Scene> read_text(std::string_view text, const std::string& folder = "/nonexistent") {
    return read_gltf(bytes_of(text), folder, "test.gltf");
}

/// Returns the body of that name; fails the test if it is missing.
inline const Body& body_named(const Scene& scene, std::string_view name) {
    for (const Body& body : scene.bodies) {
        if (body.name == name) return body;
    }
    ADD_FAILURE() << "no body is called " << name;
    static const Body empty;
    return empty;
}

/// Returns the shape of a body's collider as an S; fails the test if it is another kind.
template <class S> const S& shape_of(const Scene& scene, const Body& body, std::size_t collider = 0) {
    static const S empty{};
    if (collider >= body.colliders.size()) {
        ADD_FAILURE() << body.name << " has no collider " << collider;
        return empty;
    }
    const S* shape = std::get_if<S>(&scene.shapes[body.colliders[collider].shape]);
    if (shape == nullptr) {
        ADD_FAILURE() << body.name << " has a " << name_of(scene.shapes[body.colliders[collider].shape]);
        return empty;
    }
    return *shape;
}

template <class A, class B> void expect_near(Vec3Of<A> a, Vec3Of<B> b, double tolerance = 1e-5) {
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

}  // namespace fase::scene::test
