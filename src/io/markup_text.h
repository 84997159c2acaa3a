#pragma once

#include <string>
#include <string_view>

namespace patrol::io {

/// Text as it stands in XML 1.0 or HTML, between tags or in an attribute. Control characters have no place there: spaces, but for line ends
/// and tabs.
std::string escaped_markup(std::string_view text);

}  // namespace patrol::io
