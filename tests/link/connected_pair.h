#pragma once

#include <sys/socket.h>

#include <chrono>
#include <stdexcept>
#include <utility>

#include "link/socket.h"

namespace patrol::test {

/// Two connected sockets.
inline std::pair<link::Socket, link::Socket> connected_pair() {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) throw std::runtime_error("socketpair");
  return {link::Socket(ends[0]), link::Socket(ends[1])};
}

/// Clock of a wait (link::WaitLimit) that advances only as the test says.
struct HandClock {
  std::chrono::steady_clock::time_point now{};
  std::chrono::steady_clock::duration step{};  ///< time by which each reading advances the clock
  auto reader() {
    return [this] { return now += step; };
  }
};

}  // namespace patrol::test
