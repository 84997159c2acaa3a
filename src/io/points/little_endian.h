#pragma once

#include <cstddef>
#include <cstring>
#include <string_view>

namespace patrol::io {

/// Returns the little-endian number that begins at a byte; the caller checks the size.
template <typename Number>
Number little_endian(std::string_view bytes, std::size_t begin) {
  Number number;
  std::memcpy(&number, bytes.data() + begin, sizeof number);
  return number;
}

}  // namespace patrol::io
