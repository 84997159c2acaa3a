#pragma once

#include <string_view>

namespace patrol::io {

/// Returns whether a text begins with the byte order mark of UTF-16.
inline bool has_utf16_mark(std::string_view text) {
  return text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF");
}

/// Error text for a file in UTF-16.
constexpr std::string_view kUtf16Refusal = "is encoded as UTF-16: must be UTF-8";

}  // namespace patrol::io
