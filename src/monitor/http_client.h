#pragma once

#include <optional>
#include <string>

#include "monitor/url.h"

namespace patrol::monitor {

/// Response to a client request.
struct HttpAnswer {
  int status = 0;
  std::string body;
};

/// Posts JSON with a bearer token on a new connection. None when no complete response arrives within `limit_s`; it is
/// then unknown whether the server accepted the request. `why` receives the reason.
std::optional<HttpAnswer> post_json(const Url& url, const std::string& path, const std::string& token, const std::string& body, double limit_s,
                                    std::string* why = nullptr);

}  // namespace patrol::monitor
