#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace patrol::io {

/// RFC 4648, section 4: with padding, without line ends.
std::string to_base64(std::string_view bytes);
/// None when it is not that.
std::optional<std::string> from_base64(std::string_view text);

}  // namespace patrol::io
