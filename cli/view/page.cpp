/// Puts the parts of the viewer into its page.
#include "cli/view/page.hpp"

#include <string_view>

#include "fase/scene/detail/uri.hpp"
#include "viewer/embedded.hpp"

namespace fase::cli {
namespace {

constexpr std::size_t max_recording_bytes = std::size_t(256) << 20;

void replace_all(std::string& text, std::string_view what, std::string_view with) {
    for (std::size_t at = 0; (at = text.find(what, at)) != text.npos; at += with.size())
        text.replace(at, what.size(), with);
}

/// The script so that no part of it ends the element that it stands in. Inside strings, where alone these can stand,
/// the backslash changes nothing.
std::string inline_script() {
    std::string text(viewer::script());
    replace_all(text, "</script", "<\\/script");
    replace_all(text, "<!--", "<\\!--");
    return text;
}

}  // namespace

Result<std::string> self_contained_page(std::span<const std::byte> recording) {
    if (recording.size() > max_recording_bytes) {
        return Error{Status::Capacity, "page",
                     "found a recording of " + std::to_string(recording.size()) +
                         " bytes, need at most 268435456 for browsers to open it in a page",
                     "watch it with `fase view FILE`"};
    }
    constexpr std::string_view style_link = "<link rel=\"stylesheet\" href=\"viewer.css\">";
    constexpr std::string_view script_link = "<script src=\"viewer.js\"></script>";
    const std::string_view page = viewer::page();
    const std::size_t style_at = page.find(style_link), script_at = page.find(script_link);
    if (style_at == page.npos || script_at == page.npos || script_at < style_at) {
        return Error{Status::Unsupported, "page", "the built-in viewer does not refer to its parts as it should", {}};
    }
    const std::size_t style_end = style_at + style_link.size();
    std::string out;
    out += page.substr(0, style_at);
    out += "<style>\n";
    out += viewer::style();
    out += "</style>";
    out += page.substr(style_end, script_at - style_end);
    out += "<script id=\"recording\" type=\"application/octet-stream;base64\">";
    out += scene::encode_base64(recording);
    out += "</script>\n<script>\n";
    out += inline_script();
    out += "\n</script>";
    out += page.substr(script_at + script_link.size());
    return out;
}

}  // namespace fase::cli
