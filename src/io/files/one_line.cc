#include "io/files/one_line.h"

#include <fmt/format.h>

namespace patrol::io {
namespace {

/// Returns the length of the UTF-8 sequence at the start of `text`; 0 if the bytes are not valid UTF-8.
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  const std::size_t length = first < 0x80                    ? 1
                             : first >= 0xc2 && first < 0xe0 ? 2
                             : (first & 0xf0U) == 0xe0       ? 3
                             : first >= 0xf0 && first < 0xf5 ? 4
                                                             : 0;
  if (length == 0 || length > text.size()) return 0;
  if (length > 1) {  // no overlong forms, no surrogates, nothing above U+10FFFF
    const unsigned char second = byte(1);
    if ((first == 0xe0 && second < 0xa0) || (first == 0xed && second >= 0xa0) || (first == 0xf0 && second < 0x90) ||
        (first == 0xf4 && second >= 0x90))
      return 0;
  }
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0U) != 0x80) return 0;
  }
  return length;
}

}  // namespace

std::size_t control_length(std::string_view text) {
  if (text.empty()) return 0;
  const auto first = static_cast<unsigned char>(text[0]);
  if (first < 0x20 || first == 0x7f) return 1;
  const bool is_c1 = first == 0xc2 && text.size() > 1 && static_cast<unsigned char>(text[1]) >= 0x80 &&
                     static_cast<unsigned char>(text[1]) < 0xa0;
  return is_c1 ? 2 : 0;
}

bool has_control_characters(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (control_length(text.substr(i)) > 0) return true;
  }
  return false;
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

std::string_view first_bytes(std::string_view text, std::size_t max_bytes) {
  if (text.size() <= max_bytes) return text;
  constexpr std::size_t kMaxLength = 4;  // of a character
  for (std::size_t length = 1; length < kMaxLength && length <= max_bytes; ++length) {
    const std::size_t start = max_bytes - length;
    if (utf8_length(text.substr(start)) > length) return text.substr(0, start);
  }
  return text.substr(0, max_bytes);
}

std::string on_one_line(std::string_view text) {
  std::string line;
  while (!text.empty()) {
    const std::size_t control = control_length(text), length = utf8_length(text);
    const std::size_t count = control > 0 ? control : length > 0 ? length : 1;
    if (control == 0 && length > 0) line += text.substr(0, count);
    else if (text[0] == '\n') line += "\\n";
    else line += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[count - 1]));
    text.remove_prefix(count);
  }
  return line;
}

}  // namespace patrol::io
