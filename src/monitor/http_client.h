#pragma once

#include <optional>
#include <string>

#include "monitor/url.h"

namespace patrol::monitor {

struct HttpAnswer {
  int status = 0;
  std::string body;
};

/// Posts JSON with a bearer's token, on a connection of its own. None when no whole answer came in time: whether the other side has
/// taken it in is then unknown. `why` gets the reason.
std::optional<HttpAnswer> post_json(const Url& url, const std::string& path, const std::string& token, const std::string& body, double limit_s,
                                    std::string* why = nullptr);

}  // namespace patrol::monitor
