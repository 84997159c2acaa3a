#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace patrol::monitor {

/// Host names under which a server may be asked: "localhost", "127.0.0.1", "::1", the address at which the request came in, and names that
/// were given. A page of another site whose name was made to lead here (DNS rebinding) asks under its own name.
class HostNames {
 public:
  /// Throws InputError when a name is not a host name or an address without a port.
  explicit HostNames(const std::vector<std::string>& names = {});

  /// `host` is the request's Host header, with or without a port; `local_address` is the server's end of the connection.
  bool allow(std::string_view host, std::string_view local_address) const;

 private:
  std::vector<std::string> names_;
};

}  // namespace patrol::monitor
