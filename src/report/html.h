#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

/// Escaping of text and data for HTML pages.
namespace patrol::report {

/// JSON for a <script> element: contains no character sequence that ends the element. Invalid UTF-8 becomes U+FFFD.
std::string script_json(const nlohmann::ordered_json& value);

/// "data:image/png;base64,..." (RFC 2397, RFC 4648).
std::string data_uri(std::string_view media_type, std::string_view bytes);

}  // namespace patrol::report
