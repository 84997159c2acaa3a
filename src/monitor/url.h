#pragma once

#include <functional>
#include <map>
#include <string>

namespace patrol::monitor {

/// A request's target: its path as it stands there, and what follows the `?`, decoded (RFC 3986, 3.4; the first of a name counts).
void split_target(const std::string& target, std::string& path, std::map<std::string, std::string, std::less<>>& parameters);

/// Where a platform is.
struct Url {
  std::string host;
  std::string port;
};

/// Of "http://host[:port][/]". Throws InputError when it is anything else.
Url url_from(const std::string& text);

}  // namespace patrol::monitor
