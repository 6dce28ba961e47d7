// A program that needs fase::io: generates a scene, and reads a file that is not there.
#include <cstdio>

#include "fase/io.hpp"

int main() {
    const auto scene = fase::scene::generate("stack");
    if (!scene) return std::puts(scene.error().text().c_str()), 1;
    std::printf("%zu bodies\n", scene->bodies.size());
    const auto missing = fase::scene::read_gltf("no_such_file.glb");
    if (!missing) std::puts(missing.error().text().c_str());
    return !scene->bodies.empty() && !missing ? 0 : 2;
}
