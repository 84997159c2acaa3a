#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace patrol::link {

/// Address of a stack that is started by the user.
struct Address {
  bool is_unix = true;
  std::string path = {};  ///< Unix socket
  std::string host = {};  ///< TCP: an IPv4 address or "localhost"
  std::uint16_t port = 0;

  bool is_loopback() const;
};

/// Returns whether a text has the form of an address: it begins with "unix:" or "tcp:".
bool is_address(std::string_view text);
/// Parses "unix:PATH" or "tcp:HOST:PORT". Throws InputError.
Address parse_address(const std::string& text);

/// Limit of waiting for the other side. It counts from `start`, over several calls.
struct WaitLimit {
  std::chrono::steady_clock::duration timeout = std::chrono::seconds(10);
  std::function<bool()> is_interrupted = {};  ///< polled ten times per second while a call waits
  std::function<std::chrono::steady_clock::time_point()> clock = std::chrono::steady_clock::now;
  std::chrono::steady_clock::time_point start = clock();

  void restart() { start = clock(); }
  std::chrono::steady_clock::duration remaining() const { return start + timeout - clock(); }
  /// Throws LinkError (kTimeout). `activity`: what did not happen, "no answer".
  [[noreturn]] void fail(const char* activity) const;
};

/// Connected or listening stream socket. Calls wait as long as the wait allows and throw LinkError.
class Socket {
 public:
  explicit Socket(int descriptor) : descriptor_(descriptor) {}
  ~Socket();
  Socket(Socket&& other) noexcept;
  Socket& operator=(Socket&& other) noexcept;
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  /// Opens a socket for one client. A Unix socket is accessible only to the user, and its path must not exist. Throws
  /// InputError if the address cannot be used.
  static Socket listen(const Address& address);
  /// Connects to a listening socket. Throws LinkError.
  static Socket connect(const Address& address);

  /// Waits for a client.
  Socket accept(const WaitLimit& wait) const;
  void send(std::string_view bytes, const WaitLimit& wait);
  /// Returns how many bytes were sent without waiting: 0 also if the connection is closed.
  std::size_t send_ready(std::string_view bytes) noexcept;
  /// Returns how many bytes were received without waiting: 0 also if the connection is closed.
  std::size_t receive_ready(char* bytes, std::size_t size) noexcept;
  /// Waits for bytes and returns how many were received, at least one. Bytes that have arrived are received also after
  /// the time of the wait.
  std::size_t receive(char* bytes, std::size_t size, const WaitLimit& wait);

  /// Port of a listening TCP socket.
  std::uint16_t port() const;
  /// Process of the client of a Unix socket; 0 if unknown.
  int peer_process() const;

 private:
  int descriptor_;
};

}  // namespace patrol::link
