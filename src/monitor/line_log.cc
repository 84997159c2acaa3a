#include "monitor/line_log.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

#include <fmt/format.h>

#include "io/files/one_line.h"
#include "monitor/result.h"

namespace patrol::monitor {
namespace {

constexpr std::size_t kMaxText = 500;  // bytes; at most 2,000 after escaping, which a pipe accepts at once

}  // namespace

void LineLog::write(const std::string& text) noexcept {
  try {
    const std::string lost = num_lost_ > 0 ? fmt::format("{} earlier lines could not be written\n", num_lost_) : "";
    if (write_bytes(lost + io::on_one_line(text.substr(0, kMaxText)) + "\n")) num_lost_ = 0;
    else ++num_lost_;
  } catch (const std::exception&) {  // out of memory
    ++num_lost_;
  }
}

void LineLog::write_with_time(const std::string& text) noexcept {
  try {
    write(fmt::format("{} {}", to_utc(now_ms()), text));
  } catch (const std::exception&) {
    ++num_lost_;
  }
}

bool LineLog::write_bytes(const std::string& bytes) const {
  pollfd output{.fd = descriptor_, .events = POLLOUT, .revents = 0};
  // a full pipe would block the server
  if (::poll(&output, 1, 0) != 1 || (output.revents & POLLOUT) == 0) return false;
  ssize_t count = -1;
  do count = ::write(descriptor_, bytes.data(), bytes.size());
  while (count < 0 && errno == EINTR);
  return count == static_cast<ssize_t>(bytes.size());
}

void ignore_lost_output() {
  std::signal(SIGPIPE, SIG_IGN);
  for (int descriptor = 0; descriptor <= STDERR_FILENO; ++descriptor) {
    // gets the lowest free descriptor
    if (::fcntl(descriptor, F_GETFD) < 0 && errno == EBADF) ::open("/dev/null", O_RDWR);
  }
}

}  // namespace patrol::monitor
