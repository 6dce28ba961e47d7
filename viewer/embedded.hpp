#pragma once
/// The files of the viewer, embedded in the program.
#include <string_view>

namespace fase::viewer {

/// index.html. Its link to `viewer.css` and its script element for `viewer.js` are each on one line.
[[nodiscard]] std::string_view page();
/// The text of viewer.js.
[[nodiscard]] std::string_view script();
/// The text of viewer.css.
[[nodiscard]] std::string_view style();

}  // namespace fase::viewer
