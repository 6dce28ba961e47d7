/// The rules by which the viewer's server accepts requests.
#include "cli/view/http_guard.hpp"

#include <algorithm>
#include <cctype>
#include <optional>

namespace fase::cli {
namespace {

constexpr HttpVerdict malformed{400, "malformed request"};
constexpr HttpVerdict too_long{414, "the address is too long"};
constexpr HttpVerdict too_many{431, "the headers are too long or too many"};

bool is_token(std::string_view text) {
    static constexpr std::string_view marks = "!#$%&'*+-.^_`|~";
    return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || marks.find(c) != marks.npos;
    });
}
bool equals_lower(std::string_view text, std::string_view lower) {
    return text.size() == lower.size() && std::equal(text.begin(), text.end(), lower.begin(), [](char a, char b) {
               return static_cast<char>(std::tolower(static_cast<unsigned char>(a))) == b;
           });
}
bool is_port(std::string_view text) {
    return !text.empty() && text.size() <= 5 &&
           std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}
/// The port in "localhost:8000"; "" if there is none; nullopt for another machine.
std::optional<std::string_view> port_of_this_machine(std::string_view authority) {
    for (const std::string_view name : {"localhost", "127.0.0.1", "[::1]"}) {
        if (!equals_lower(authority.substr(0, name.size()), name)) continue;
        const std::string_view rest = authority.substr(name.size());
        if (rest.empty()) return rest;
        if (rest[0] == ':' && is_port(rest.substr(1))) return rest.substr(1);
    }
    return std::nullopt;
}
bool is_own_origin(std::string_view origin, int port) {
    constexpr std::string_view scheme = "http://";
    if (!origin.starts_with(scheme)) return false;
    const auto named = port_of_this_machine(origin.substr(scheme.size()));
    return named && *named == (port == 80 ? std::string_view() : std::string_view(std::to_string(port)));
}
bool is_plain_path(std::string_view target) {
    const std::string_view path = target.substr(0, target.find('?'));
    return path.starts_with('/') && path.find("//") == path.npos && path.find("..") == path.npos &&
           path.find_first_of("%\\#;") == path.npos;
}
std::string_view trimmed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
    return text;
}

HttpVerdict check_request_line(std::string_view line, bool& needs_host) {
    const std::size_t first = line.find(' '), last = line.rfind(' ');
    if (first == line.npos || first == last) return malformed;
    const std::string_view method = line.substr(0, first), target = line.substr(first + 1, last - first - 1);
    const std::string_view version = line.substr(last + 1);
    if (!is_token(method) || (version != "HTTP/1.1" && version != "HTTP/1.0")) return malformed;
    if (method != "GET" && method != "HEAD") return {405, "only GET and HEAD are answered"};
    if (target.size() > max_target_bytes) return too_long;
    if (target.find(' ') != target.npos || !is_plain_path(target)) return malformed;
    needs_host = version == "HTTP/1.1";
    return {};
}

}  // namespace

HttpVerdict check_partial_head(std::string_view received) {
    if (received.find('\n') == received.npos && received.size() > max_target_bytes + 100) return too_long;
    return received.size() > max_head_bytes ? too_many : HttpVerdict{};
}

HttpVerdict check_head(std::string_view head, int port) {
    if (const HttpVerdict verdict = check_partial_head(head); verdict.code != 0) return verdict;
    const bool control_bytes = std::any_of(head.begin(), head.end(), [](char c) {
        return (static_cast<unsigned char>(c) < 32 && c != '\r' && c != '\n' && c != '\t') || c == 127;
    });
    if (control_bytes) return malformed;
    const std::size_t line_end = head.find("\r\n");
    if (line_end == head.npos) return malformed;
    bool needs_host = false;
    if (const HttpVerdict verdict = check_request_line(head.substr(0, line_end), needs_host); verdict.code != 0)
        return verdict;
    std::size_t lines = 0, hosts = 0, at = line_end + 2;
    HttpVerdict refused;
    while (at < head.size()) {
        const std::size_t end = head.find("\r\n", at);
        if (end == head.npos) return malformed;
        const std::string_view line = head.substr(at, end - at);
        at = end + 2;
        if (line.empty()) break;
        if (++lines > max_header_lines) return too_many;
        const std::size_t colon = line.find(':');
        if (colon == line.npos || line.find_first_of("\r\n") != line.npos || !is_token(line.substr(0, colon)))
            return malformed;
        const std::string_view name = line.substr(0, colon), value = trimmed(line.substr(colon + 1));
        if (equals_lower(name, "host")) {
            ++hosts;
            if (!port_of_this_machine(value)) refused = {403, "only pages of this machine are answered (Host)"};
        } else if (equals_lower(name, "origin")) {
            if (!is_own_origin(value, port)) refused = {403, "only pages of this server are answered (Origin)"};
        } else if (equals_lower(name, "transfer-encoding") || (equals_lower(name, "content-length") && value != "0")) {
            return {400, "a request for a page has no body"};
        }
    }
    if (at != head.size() || hosts > 1 || (needs_host && hosts == 0)) return malformed;
    return refused;
}

}  // namespace fase::cli
