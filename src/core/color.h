#pragma once

#include <cstdint>

namespace patrol {

/// Color of a pixel: RGB, 8 bits per channel.
struct Color {
  std::uint8_t r = 0, g = 0, b = 0;
  friend bool operator==(const Color&, const Color&) = default;
};
static_assert(sizeof(Color) == 3);

}  // namespace patrol
