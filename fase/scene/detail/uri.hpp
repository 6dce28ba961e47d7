#pragma once
/// Uris of glTF files: paths inside the model's folder, and base64 data.
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fase/core/result.hpp"

namespace fase::scene {

/// Resolves a glTF uri (RFC 3986 reference, percent-decoded) relative to `folder`. Accepts only relative paths that,
/// with links resolved, are below the folder. Format for absolute paths, schemes, drive letters, backslashes, NUL,
/// "..", and files that do not exist. Never accesses the network.
Result<std::string> resolve_uri(const std::string& folder, std::string_view uri);

/// Decodes a base64 "data:" uri (RFC 4648, padding required). Format for any other uri.
Result<std::vector<std::byte>> decode_data_uri(std::string_view uri);
/// Encodes bytes as base64 with padding.
[[nodiscard]] std::string encode_base64(std::span<const std::byte> bytes);

}  // namespace fase::scene
