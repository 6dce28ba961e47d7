#pragma once
/// Output that all commands share: exit codes, error lines, text that is safe to print, checks of output files.
#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>

#include "fase/core/result.hpp"

namespace fase::cli {

/// The program's exit codes. 128 + n: ended by signal n.
inline constexpr int exit_ok = 0;
inline constexpr int exit_check_failed = 1;  ///< a requested check failed
inline constexpr int exit_bad_input = 2;     ///< invalid command line or file
inline constexpr int exit_io = 3;
inline constexpr int exit_limit = 4;  ///< a limit was exceeded or memory ran out
inline constexpr int exit_bug = 70;   ///< an internal error

/// The exit code for an error with this status.
[[nodiscard]] int exit_code(Status status);

/// `text` on one line and safe for a terminal: control characters and invalid UTF-8 become \n, \t or \xNN. Text of more
/// than `max_bytes` is cut and ends with an ellipsis.
[[nodiscard]] std::string printable(std::string_view text, std::size_t max_bytes = std::string_view::npos);

/// Prints `fase: SORT: TEXT` as one line on stderr; `sort`: "error" or "warning".
void print_line(std::string_view sort, std::string_view text);

/// Prints `fase: error: WHERE: PROBLEM; REMEDY` as one line on stderr and returns the exit code.
int refuse(const Error& error);

/// Opens /dev/null for standard streams that are closed, so that no other file gets their descriptors. Ignores SIGPIPE
/// and SIGXFSZ: a write to a closed pipe or beyond the limit of file sizes fails instead of ending the program.
void guard_standard_streams();

/// Flushes stdout and returns `code`. If the flush fails: 141 (the reader closed the pipe), or exit_io with an error
/// line. Call last.
[[nodiscard]] int finish_output(int code);

/// A kind of file that commands write, and the extensions of its names.
struct OutputKind {
    std::string_view name;  ///< "a recording"
    std::string_view extension;
    std::string_view other_extension = {};  ///< empty: none
};

namespace output {
inline constexpr OutputKind recording{"a recording", ".faserec"}, trace{"a trace", ".aabt"}, page{"a page", ".html"},
    animation{"an animation", ".glb"}, scene{"a scene", ".glb", ".gltf"}, wad{"a WAD", ".wad"},
    drawing{"a drawing", ".svg"}, image{"an image", ".png"}, atlas_data{"the data of an atlas", ".json"},
    table{"a table", ".csv"};
}  // namespace output

/// Whether the name ends with an extension of that kind.
[[nodiscard]] bool has_extension(const std::string& path, const OutputKind& kind);

/// Checks, without writing, that a file of one of the kinds can be written at `path`. All output options use it, before
/// any other work. Io when it is a folder, read-only, the same file as `input` (empty: no input file), or when its
/// folder is read-only or cannot be created. BadArgument for an empty path, and for another extension; devices and
/// pipes may have any name.
Result<void> check_output(const std::string& path, std::initializer_list<OutputKind> kinds,
                          const std::string& input = {});

/// Creates the folder of `path`, and those above it, if they are missing. Call it right before the file is written.
Result<void> make_folder_of(const std::string& path);

}  // namespace fase::cli
