#pragma once

#include <optional>
#include <string_view>

namespace patrol::monitor {

struct PngSize {
  int width = 0;
  int height = 0;
};

/// From the head of a PNG; none when the bytes do not begin like one (PNG specification, 5.2 and 11.2.2). What follows is left to the
/// browser.
inline std::optional<PngSize> png_size(std::string_view bytes) {
  constexpr std::string_view kHead("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16);
  if (!bytes.starts_with(kHead) || bytes.size() < 24) return std::nullopt;
  const auto number_at = [&](std::size_t at) {
    unsigned value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
    return static_cast<int>(value & 0x7fffffffU);
  };
  return PngSize{.width = number_at(16), .height = number_at(20)};
}

}  // namespace patrol::monitor
