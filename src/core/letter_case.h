#pragma once

#include <string>

namespace patrol {

/// Returns the text with ASCII letters in lower case.
inline std::string to_lower(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

}  // namespace patrol
