#pragma once

#include <functional>
#include <map>
#include <string>

namespace patrol::monitor {

/// Splits a request target into the path as sent and the decoded query parameters (RFC 3986, 3.4). The first value of a
/// repeated name is used.
void split_target(const std::string& target, std::string& path,
                  std::map<std::string, std::string, std::less<>>& parameters);

/// Host and port of a monitoring server.
struct Url {
  std::string host;
  std::string port;
};

/// Parses "http://host[:port][/]". Throws InputError for any other text.
Url parse_url(const std::string& text);

}  // namespace patrol::monitor
