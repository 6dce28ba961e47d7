#pragma once
/// The uris of glTF files: paths inside the model's folder, and data in base64.
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fase/core/result.hpp"

namespace fase::scene {

/// The path that a file of `folder` means by a glTF uri (RFC 3986 reference, percent-decoded). Only relative paths
/// whose real place, links followed, lies under the folder; Format for absolute ones, schemes, drive letters,
/// backslashes, NUL, "..", and for files that do not exist. Never goes to the network.
Result<std::string> resolve_uri(const std::string& folder, std::string_view uri);

/// The bytes of a "data:" uri in base64 (RFC 4648, padding required). Format otherwise.
Result<std::vector<std::byte>> decode_data_uri(std::string_view uri);
/// Base64 with padding.
[[nodiscard]] std::string encode_base64(std::span<const std::byte> bytes);

}  // namespace fase::scene
