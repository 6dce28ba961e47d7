#pragma once
/// Checks the head of an HTTP request before any other code reads it.
#include <cstddef>
#include <string>
#include <string_view>

namespace fase::cli {

/// Limits of a request's head.
inline constexpr std::size_t max_target_bytes = 8000, max_head_bytes = 32768, max_header_lines = 100;

/// The answer to a refused request; code 0: accepted.
struct HttpVerdict {
    int code = 0;
    const char* reason = "";  ///< one line for the sender
};

/// Checks a head that is not yet complete: refuses it once it is too long.
/// @param received all bytes up to now, without the end of the head
[[nodiscard]] HttpVerdict check_partial_head(std::string_view received);

/// Checks a complete head, from the request line to the empty line. Accepts only GET and HEAD of plain paths, without a
/// body, for this host and from pages of this host. 400 malformed, 403 another Host or Origin (a page of another site,
/// DNS rebinding), 405 another method, 414, 431.
/// @param port the server's port; an Origin must have it
[[nodiscard]] HttpVerdict check_head(std::string_view head, int port);

}  // namespace fase::cli
