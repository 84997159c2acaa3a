#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

/// The few things that keep a page whole whatever stands in a run's files.
namespace patrol::render {

/// Text for HTML, attributes included. Line ends stay, other control characters become spaces.
std::string escaped_html(std::string_view text);

/// JSON that can stand in a <script>: no character in it can end the element. Bytes that are not UTF-8 become U+FFFD.
std::string script_json(const nlohmann::ordered_json& value);

/// "data:image/png;base64,..." (RFC 2397, RFC 4648).
std::string data_uri(std::string_view media_type, std::string_view bytes);

}  // namespace patrol::render
