#include "link/socket.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "link/link_error.h"

namespace patrol::link {
namespace {

constexpr std::chrono::milliseconds kSlice{100};  ///< maximum time between two checks for an interrupt

/// Waits until the descriptor is ready. Throws LinkError if that takes longer than the wait. The time is judged before
/// the last look at the descriptor: what is ready by then counts, however late this process looks.
void wait_for(int descriptor, short events, const WaitLimit& wait, const char* activity) {
  while (true) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(wait.remaining());
    pollfd ready{.fd = descriptor, .events = events, .revents = 0};
    const auto slice = std::clamp(left, std::chrono::milliseconds(0), kSlice);
    if (::poll(&ready, 1, static_cast<int>(slice.count())) > 0) return;
    if (wait.is_interrupted && wait.is_interrupted()) throw LinkError(LinkFault::kInterrupted, "interrupted");
    if (left.count() <= 0) wait.fail(activity);
  }
}

sockaddr_un unix_address(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof(address.sun_path)) {
    throw InputError(
        fmt::format("unix:{}: path of the socket is longer than {} bytes", path, sizeof(address.sun_path) - 1));
  }
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  return address;
}

sockaddr_in tcp_address(const Address& address) {
  sockaddr_in socket_address{};
  socket_address.sin_family = AF_INET;
  socket_address.sin_port = htons(address.port);
  const std::string host = address.host == "localhost" ? "127.0.0.1" : address.host;
  if (::inet_pton(AF_INET, host.c_str(), &socket_address.sin_addr) != 1)
    throw InputError(fmt::format("tcp:{}:{}: host must be an IPv4 address or localhost", address.host, address.port));
  return socket_address;
}

std::string text_of(const Address& address) {
  return address.is_unix ? "unix:" + address.path : fmt::format("tcp:{}:{}", address.host, address.port);
}

/// Calls bind or connect with the socket address of an address.
template <typename Call>
int call_with(const Address& address, const Call& call) {
  if (address.is_unix) {
    const sockaddr_un name = unix_address(address.path);
    return call(reinterpret_cast<const sockaddr*>(&name), static_cast<socklen_t>(sizeof(name)));
  }
  const sockaddr_in name = tcp_address(address);
  return call(reinterpret_cast<const sockaddr*>(&name), static_cast<socklen_t>(sizeof(name)));
}

/// Returns whether an address is a Unix socket on which no process listens. The probe has another type than the sockets
/// of stacks: a process that listens gets no connection by it.
bool is_left_over(const Address& address) {
  struct stat status {};
  if (!address.is_unix || ::stat(address.path.c_str(), &status) != 0 || !S_ISSOCK(status.st_mode)) return false;
  const int probe = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const bool is_refused =
      call_with(address, [&](const sockaddr* name, socklen_t size) { return ::connect(probe, name, size); }) != 0 &&
      errno == ECONNREFUSED;
  ::close(probe);
  return is_refused;
}

Socket open_socket(const Address& address) {
  const int descriptor = ::socket(address.is_unix ? AF_UNIX : AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (descriptor < 0) throw LinkError(LinkFault::kClosed, fmt::format("socket: {}", std::strerror(errno)));
  return Socket(descriptor);
}

}  // namespace

void WaitLimit::fail(const char* activity) const {
  throw LinkError(LinkFault::kTimeout,
                  fmt::format("{} within {:g} s", activity, std::chrono::duration<double>(timeout).count()));
}

bool Address::is_loopback() const { return is_unix || host == "localhost" || host.starts_with("127."); }

bool is_address(std::string_view text) { return text.starts_with("unix:") || text.starts_with("tcp:"); }

Address parse_address(const std::string& text) {
  if (text.starts_with("unix:") && text.size() > 5) return {.is_unix = true, .path = text.substr(5)};
  const std::size_t colon = text.rfind(':');
  if (text.starts_with("tcp:") && colon > 4) {
    Address address{.is_unix = false, .host = text.substr(4, colon - 4)};
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data() + colon + 1, end, address.port);
    if (error == std::errc() && stop == end && colon + 1 < text.size()) {
      tcp_address(address);  // checks the host
      return address;
    }
  }
  throw InputError(fmt::format("{}: must be unix:PATH or tcp:HOST:PORT", text));
}

Socket::~Socket() {
  if (descriptor_ >= 0) ::close(descriptor_);
}
Socket::Socket(Socket&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
Socket& Socket::operator=(Socket&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

Socket Socket::listen(const Address& address) {
  Socket socket = open_socket(address);
  const int on = 1;
  ::setsockopt(socket.descriptor_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
  const mode_t mask = ::umask(0077);
  const int bound =
      call_with(address, [&](const sockaddr* name, socklen_t size) { return ::bind(socket.descriptor_, name, size); });
  const int error = errno;
  ::umask(mask);
  if (bound != 0) {
    const bool is_free = error == EADDRINUSE && is_left_over(address);
    throw InputError(fmt::format("{}: {}{}", text_of(address), std::strerror(error),
                                 is_free ? ", but no process listens there: remove the file" : ""));
  }
  if (::listen(socket.descriptor_, 1) != 0)
    throw InputError(fmt::format("{}: {}", text_of(address), std::strerror(errno)));
  return socket;
}

Socket Socket::connect(const Address& address) {
  Socket socket = open_socket(address);
  const int connected = call_with(
      address, [&](const sockaddr* name, socklen_t size) { return ::connect(socket.descriptor_, name, size); });
  if (connected != 0) {
    throw LinkError(LinkFault::kClosed, fmt::format("{}: cannot connect: {}", text_of(address), std::strerror(errno)));
  }
  const int on = 1;
  if (!address.is_unix) ::setsockopt(socket.descriptor_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
  return socket;
}

Socket Socket::accept(const WaitLimit& wait) const {
  wait_for(descriptor_, POLLIN, wait, "no stack connected");
  const int accepted = ::accept4(descriptor_, nullptr, nullptr, SOCK_CLOEXEC);
  if (accepted < 0) throw LinkError(LinkFault::kClosed, fmt::format("no stack connected: {}", std::strerror(errno)));
  const int on = 1;
  ::setsockopt(accepted, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));  // has no effect on a Unix socket
  return Socket(accepted);
}

void Socket::send(std::string_view bytes, const WaitLimit& wait) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent > 0) {
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    } else if (errno == EAGAIN) {
      wait_for(descriptor_, POLLOUT, wait, "no messages accepted");
    } else if (errno != EINTR) {
      throw LinkError(LinkFault::kClosed, "connection closed");
    }
  }
}

std::size_t Socket::send_ready(std::string_view bytes) noexcept {
  const ssize_t sent = ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  return sent > 0 ? static_cast<std::size_t>(sent) : 0;
}

std::size_t Socket::receive(char* bytes, std::size_t size, const WaitLimit& wait) {
  while (true) {
    const ssize_t received = ::recv(descriptor_, bytes, size, MSG_DONTWAIT);
    if (received > 0) return static_cast<std::size_t>(received);
    if (received == 0 || (errno != EINTR && errno != EAGAIN)) throw LinkError(LinkFault::kClosed, "connection closed");
    wait_for(descriptor_, POLLIN, wait, "no answer");
  }
}

std::size_t Socket::receive_ready(char* bytes, std::size_t size) noexcept {
  const ssize_t received = ::recv(descriptor_, bytes, size, MSG_DONTWAIT);
  return received > 0 ? static_cast<std::size_t>(received) : 0;
}

std::uint16_t Socket::port() const {
  sockaddr_in name{};
  socklen_t size = sizeof(name);
  if (::getsockname(descriptor_, reinterpret_cast<sockaddr*>(&name), &size) != 0 || name.sin_family != AF_INET)
    return 0;
  return ntohs(name.sin_port);
}

int Socket::peer_process() const {
  ucred credentials{};
  socklen_t size = sizeof(credentials);
  const bool is_known = ::getsockopt(descriptor_, SOL_SOCKET, SO_PEERCRED, &credentials, &size) == 0;
  return is_known ? credentials.pid : 0;
}

}  // namespace patrol::link
