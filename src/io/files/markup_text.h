#pragma once

#include <string>
#include <string_view>

namespace patrol::io {

/// Escapes text for XML 1.0 or HTML, between tags or in an attribute. Control characters become spaces, except line
/// ends and tabs.
std::string escaped_markup(std::string_view text);

}  // namespace patrol::io
