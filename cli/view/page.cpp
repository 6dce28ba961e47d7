/// Builds one self-contained page from the parts of the viewer.
#include "cli/view/page.hpp"

#include <string_view>

#include "fase/scene/detail/uri.hpp"
#include "viewer/embedded.hpp"

namespace fase::cli {
namespace {

constexpr std::size_t max_recording_bytes = std::size_t(256) << 20;

void replace_all(std::string& text, std::string_view what, std::string_view with) {
    for (std::size_t i = 0; (i = text.find(what, i)) != text.npos; i += with.size()) text.replace(i, what.size(), with);
}

/// The script, escaped so that it cannot close its own element. These sequences occur only inside strings, where the
/// backslash has no effect.
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
                         " bytes; expected at most 268435456, the limit of browsers for a page",
                     "use `fase view FILE`"};
    }
    constexpr std::string_view style_link = "<link rel=\"stylesheet\" href=\"viewer.css\">";
    constexpr std::string_view script_link = "<script src=\"viewer.js\"></script>";
    const std::string_view page = viewer::page();
    const std::size_t style_at = page.find(style_link), script_at = page.find(script_link);
    if (style_at == page.npos || script_at == page.npos || script_at < style_at) {
        return Error{Status::Unsupported, "page", "the embedded page does not link the embedded style and script", {}};
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
