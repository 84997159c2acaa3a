#pragma once

#include <optional>
#include <string>

#include "monitor/url.h"

namespace patrol::monitor {

/// Response to a client request.
struct HttpClientResponse {
  int status = 0;
  std::string body;
};

/// Posts JSON with a bearer token on a new connection. None when no complete response arrives within `timeout_s`; it is
/// then unknown whether the server accepted the request. `why` receives the reason.
std::optional<HttpClientResponse> post_json(const Url& url, const std::string& path, const std::string& token,
                                            const std::string& body, double timeout_s, std::string* reason = nullptr);

}  // namespace patrol::monitor
