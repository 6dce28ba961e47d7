#pragma once
/// The viewer and a recording as one page that browsers open from a file.
#include <cstddef>
#include <span>
#include <string>

#include "fase/core/result.hpp"

namespace fase::cli {

/// Returns HTML that contains script, style and recording, without any external reference. Capacity when the recording
/// exceeds the limit of browsers for a page (256 MiB).
Result<std::string> self_contained_page(std::span<const std::byte> recording);

}  // namespace fase::cli
