#include "app/common/text_style.h"

#include <unistd.h>

#include <cstdlib>

#include <fmt/format.h>

namespace patrol::app {

TextStyle output_style() {
  const char* no_color = std::getenv("NO_COLOR");  // https://no-color.org
  const bool has_color = ::isatty(STDOUT_FILENO) == 1 && (no_color == nullptr || *no_color == '\0');
  return has_color ? TextStyle::kColor : TextStyle::kPlain;
}

std::string met_text(bool is_met, TextStyle style) { return colored(is_met ? "met" : "MISSED", is_met, style); }

std::string colored(const std::string& text, bool is_good, TextStyle style) {
  return style == TextStyle::kPlain ? text : fmt::format("\033[{}m{}\033[0m", is_good ? 32 : 31, text);
}

}  // namespace patrol::app
