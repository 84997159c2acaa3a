#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace patrol::monitor {

/// Accepted host names of a server: "localhost", "127.0.0.1", "::1", the local address of the connection, and
/// configured names. Protects against DNS rebinding: a page of another site sends its own host name.
class HostNames {
 public:
  /// Throws InputError when a name is not a host name or an address without a port.
  explicit HostNames(const std::vector<std::string>& names = {});

  /// Returns true for an accepted host. `host` is the request's Host header, with or without a port; `local_address` is
  /// the server's end of the connection.
  bool allow(std::string_view host, std::string_view local_address) const;

 private:
  std::vector<std::string> names_;
};

}  // namespace patrol::monitor
