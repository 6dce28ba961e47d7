/// Entry point of the glTF reader: opens the file and converts exceptions to errors.
#include "fase/scene/gltf.hpp"

#include <new>
#include <stdexcept>

#include "fase/core/detail/file_kind.hpp"
#include "fase/core/detail/files.hpp"
#include "fase/scene/gltf/assemble.hpp"

namespace fase::scene {

Result<Scene> read_gltf(const std::string& path) {
    constexpr std::size_t max_bytes = std::size_t{1} << 32;
    try {
        const Result<std::vector<std::byte>> bytes = read_file(path, max_bytes);
        if (!bytes) return bytes.error();
        return read_gltf(*bytes, folder_of(path), path);
    } catch (const std::bad_alloc&) {
        return Error{Status::NoMemory, path, "found too little memory to read the file", {}};
    }
}

Result<Scene> read_gltf(const std::vector<std::byte>& bytes, const std::string& folder, const std::string& name) {
    const FileKind kind = kind_of(bytes);
    const bool is_json = kind == FileKind::Gltf || kind == FileKind::Json;
    if (kind != FileKind::Glb && !is_json && kind != FileKind::Other)
        return wrong_kind(name, kind, "a glTF scene (.gltf or .glb)");
    try {
        gltf::Document document(bytes, folder);
        return gltf::assemble(document);
    } catch (const gltf::Refusal& refusal) {
        Error error = refusal.error;
        error.where = error.where.empty() ? name : name + ": " + error.where;
        return error;
    } catch (const std::bad_alloc&) {
        return Error{Status::NoMemory, name, "found too little memory to read the file", {}};
    } catch (const std::length_error&) {
        return Error{Status::NoMemory, name, "found more elements than memory can hold", {}};
    }
}

}  // namespace fase::scene
