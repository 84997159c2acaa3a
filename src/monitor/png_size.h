#pragma once

#include <optional>
#include <string_view>

namespace patrol::monitor {

struct PngSize {
  int width = 0;
  int height = 0;
};

/// Size in the header of a PNG (PNG specification, 5.2 and 11.2.2); none when the bytes do not begin like a PNG, or when a side is outside
/// 1 ... 2^31 - 1. The image data are not checked.
inline std::optional<PngSize> png_size(std::string_view bytes) {
  constexpr std::string_view kHead("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16);
  if (!bytes.starts_with(kHead) || bytes.size() < 24) return std::nullopt;
  const auto number_at = [&](std::size_t at) {
    unsigned value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
    return value;
  };
  constexpr unsigned kMax = 0x7fffffff;
  const unsigned width = number_at(16), height = number_at(20);
  if (width < 1 || width > kMax || height < 1 || height > kMax) return std::nullopt;
  return PngSize{.width = static_cast<int>(width), .height = static_cast<int>(height)};
}

}  // namespace patrol::monitor
