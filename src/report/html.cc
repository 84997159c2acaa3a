#include "report/html.h"

#include "io/files/base64.h"

namespace patrol::report {

std::string script_json(const nlohmann::ordered_json& value) {
  const std::string json = value.dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace);
  std::string out;
  out.reserve(json.size());
  for (const char c : json) {  // '<' occurs only in strings, where the escape is equivalent
    if (c == '<') out += "\\u003c";
    else out += c;
  }
  return out;
}

std::string data_uri(std::string_view media_type, std::string_view bytes) {
  return "data:" + std::string(media_type) + ";base64," + io::to_base64(bytes);
}

}  // namespace patrol::report
