#include "monitor/host_names.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"

namespace patrol::monitor {
namespace {

/// Host in lower case without port and brackets, empty when it is not a host.
std::string plain_host(std::string_view host) {
  std::string_view port;
  if (host.starts_with('[')) {
    const std::size_t end = std::min(host.find(']'), host.size());
    if (end == host.size()) return "";
    port = host.substr(end + 1);
    host = host.substr(1, end - 1);
  } else if (const std::size_t colon = host.find(':'); colon != std::string_view::npos) {
    port = host.substr(colon);
    host = host.substr(0, colon);
  }
  const bool is_port =
      port.empty() || (port[0] == ':' && port.find_first_not_of("0123456789", 1) == std::string_view::npos);
  if (!is_port || host.find_first_of("/?#@ ") != std::string_view::npos) return "";
  std::string plain(host);
  std::ranges::transform(plain, plain.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return plain;
}

}  // namespace

HostNames::HostNames(const std::vector<std::string>& names) : names_{"localhost", "127.0.0.1", "::1"} {
  for (const std::string& name : names) {
    const bool is_bare_v6 = std::ranges::count(name, ':') > 1 && !name.starts_with('[');
    const std::string plain = plain_host(is_bare_v6 ? "[" + name + "]" : name);
    const bool has_port = !is_bare_v6 && name.find(':') != std::string::npos && !name.ends_with(']');
    if (plain.empty() || has_port)
      throw InputError(fmt::format("{}: must be a host name or an address, without a port", name));
    names_.push_back(plain);
  }
}

bool HostNames::allow(std::string_view host, std::string_view local_address) const {
  const std::string plain = plain_host(host);
  return !plain.empty() && (plain == local_address || std::ranges::find(names_, plain) != names_.end());
}

}  // namespace patrol::monitor
