#pragma once
/// The viewer and a recording as one page that opens from a file.
#include <cstddef>
#include <span>
#include <string>

#include "fase/core/result.hpp"

namespace fase::cli {

/// HTML with script, style and recording inside; refers to nothing outside itself. Capacity when the recording is
/// longer than browsers take inside a page (256 MiB).
Result<std::string> self_contained_page(std::span<const std::byte> recording);

}  // namespace fase::cli
