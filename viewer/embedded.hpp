#pragma once
/// The files of the viewer, built in.
#include <string_view>

namespace fase::viewer {

/// index.html: refers to `viewer.css` by a link and to `viewer.js` by a script element, each on a line.
[[nodiscard]] std::string_view page();
/// viewer.js
[[nodiscard]] std::string_view script();
/// viewer.css
[[nodiscard]] std::string_view style();

}  // namespace fase::viewer
