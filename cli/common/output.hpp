#pragma once
/// What every command shares in talking to the outside: exit codes, error lines, text that is safe to show, output
/// files.
#include <string>
#include <string_view>

#include "fase/core/result.hpp"

namespace fase::cli {

/// What the program's exit codes mean. 128 + n: ended by signal n.
inline constexpr int exit_ok = 0;
inline constexpr int exit_check_failed = 1;  ///< a check that was asked for failed
inline constexpr int exit_bad_input = 2;     ///< a command line or a file that cannot be meant
inline constexpr int exit_io = 3;
inline constexpr int exit_limit = 4;  ///< a limit or the memory is used up
inline constexpr int exit_bug = 70;   ///< a mistake of ours

/// The exit code for an error of that kind.
[[nodiscard]] int exit_code(Status status);

/// `text` on one line and harmless on a terminal: control characters and broken UTF-8 as \n, \t or \xNN; of more than
/// `most` bytes the first, and an ellipsis.
[[nodiscard]] std::string printable(std::string_view text, std::size_t most = std::string_view::npos);

/// Prints `fase: error: WHERE: PROBLEM; REMEDY` as one line on stderr and returns the exit code.
int refuse(const Error& error);

/// Opens /dev/null in the place of standard streams that are closed, so that no file of ours gets their numbers, and
/// lets writes to a pipe that nobody reads fail instead of ending the program.
void guard_standard_streams();

/// To be called last: hands what was printed on, and returns `code`; or, when that fails, 141 (nobody reads any more)
/// or exit_io with an error line.
[[nodiscard]] int finish_output(int code);

/// Whether a file can be written under `path`, without writing it. Io when it is a folder, read-only, the same file as
/// `input` (may be empty: none), or its folder is missing or read-only; BadArgument when it is empty.
Result<void> check_output(const std::string& path, const std::string& input = {});

}  // namespace fase::cli
