#pragma once
/// Checks of input files: what a command reads, and which command reads a file of another kind.
#include <span>
#include <string>
#include <string_view>

#include "fase/core/detail/file_kind.hpp"
#include "fase/core/result.hpp"

namespace fase::cli {

/// The files that a command reads.
struct InputKinds {
    std::string_view command;  ///< "run"
    std::string_view reads;    ///< "scenes (.gltf, .glb)", for the error
    std::span<const FileKind> kinds;
};

namespace input {
inline constexpr FileKind trace_kinds[]{FileKind::Trace};
inline constexpr std::string_view traces = "traces (.aabt)";
}  // namespace input

/// The kind of the file at `path`, by its content. Errors of read_start(); Format for a kind that the command does not
/// read: the message names what was found and the command that reads it.
Result<FileKind> check_input(const std::string& path, const InputKinds& expected);

/// `text` as one word of a shell's command line, quoted if it has to be.
[[nodiscard]] std::string shell_word(const std::string& text);

}  // namespace fase::cli
