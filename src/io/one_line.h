#pragma once

#include <string>
#include <string_view>

namespace patrol::io {

/// Text for one line of a terminal or a log: line ends and other control characters in it are written out.
std::string on_one_line(std::string_view text);

}  // namespace patrol::io
