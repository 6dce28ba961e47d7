#pragma once
/// Judges the head of an HTTP request before any other code reads it.
#include <string>
#include <string_view>

namespace fase::cli {

/// Limits of a request's head.
inline constexpr std::size_t max_target_bytes = 8000, max_head_bytes = 32768, max_header_lines = 100;

/// What to answer a request that is not let through; code 0: let through.
struct HttpVerdict {
    int code = 0;
    const char* reason = "";  ///< one line for the person who sent it
};

/// Where a head that is still coming in stands.
/// @param so_far the bytes that came; no end of the head among them
/// @return a verdict as soon as it is already too long
[[nodiscard]] HttpVerdict judge_unfinished(std::string_view so_far);

/// Judges a whole head, from the request line to the empty line: only GET and HEAD of plain paths, without a body, for
/// this host and from pages of this host. 400 malformed, 403 another Host or Origin (a page of another site, DNS
/// rebinding), 405 another method, 414, 431.
/// @param port that the server listens on; an Origin must name it
[[nodiscard]] HttpVerdict judge(std::string_view head, int port);

}  // namespace fase::cli
