#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace patrol::io {

/// Returns the length in bytes of the control character at the start of UTF-8 text: C0, DEL or C1 (U+0080 to U+009F). 0
/// if the text starts with another character.
std::size_t control_length(std::string_view text);
bool has_control_characters(std::string_view text);

bool is_utf8(std::string_view text);
/// Returns the first bytes of text, at most `max_bytes`, without a character of UTF-8 that is cut off.
std::string_view first_bytes(std::string_view text, std::size_t max_bytes);

/// Formats text for one line of a terminal or a log: line ends, other control characters and invalid UTF-8 are escaped.
std::string on_one_line(std::string_view text);

}  // namespace patrol::io
