#pragma once

#include <string>
#include <string_view>

namespace patrol {

/// Returns the parts in one string, with the separator between them. Compiles faster than fmt::join.
template <typename Strings>
std::string join(const Strings& parts, std::string_view separator) {
  std::string text;
  bool is_first = true;
  for (const std::string_view part : parts) {
    if (!is_first) text += separator;
    text += part;
    is_first = false;
  }
  return text;
}

}  // namespace patrol
