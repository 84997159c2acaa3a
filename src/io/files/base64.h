#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace patrol::io {

/// Encodes bytes in base64 (RFC 4648, section 4): with padding, without line breaks.
std::string to_base64(std::string_view bytes);
/// Decodes base64; nullopt if the text is not valid.
std::optional<std::string> from_base64(std::string_view text);

}  // namespace patrol::io
