#pragma once

#include <cstring>
#include <string>

namespace patrol::test {

/// Returns the bytes of a number, little-endian.
template <typename Number>
std::string bytes(Number number) {
  std::string raw(sizeof(number), '\0');
  std::memcpy(raw.data(), &number, sizeof(number));
  return raw;
}

}  // namespace patrol::test
