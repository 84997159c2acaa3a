#pragma once

#include <cstdint>
#include <string>

namespace patrol::app {

enum class TextStyle : std::uint8_t { kPlain, kColor };

/// Style of standard output: colors on a terminal unless the environment variable NO_COLOR is set, else plain text.
TextStyle output_style();

/// "met" in green or "MISSED" in red.
std::string met_text(bool is_met, TextStyle style);

/// `text` in green or red.
std::string colored(const std::string& text, bool is_good, TextStyle style);

}  // namespace patrol::app
