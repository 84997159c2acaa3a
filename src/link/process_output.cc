#include "link/process_output.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

#include "core/error.h"

namespace patrol::link {
namespace {

constexpr int kPipeBytes = 1 << 20;

void close_descriptor(int& descriptor) {
  if (descriptor >= 0) ::close(descriptor);
  descriptor = -1;
}

/// Writes as much as the file takes. A full disk ends no run because of the output of a process.
void write_all(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

/// Copies what a pipe holds. Returns false at its end.
bool copy_available(int pipe, int file) {
  std::array<char, 1 << 14> buffer;
  while (true) {
    const ssize_t received = ::read(pipe, buffer.data(), buffer.size());
    if (received > 0) {
      write_all(file, {buffer.data(), static_cast<std::size_t>(received)});
    } else if (received == 0 || errno != EINTR) {
      return received != 0 && errno == EAGAIN;
    }
  }
}

}  // namespace

ProcessOutput::ProcessOutput() {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error(fmt::format("pipe: {}", std::strerror(errno)));
  reading_end_ = ends[0], writing_end_ = ends[1];
  ::fcntl(reading_end_, F_SETPIPE_SZ, kPipeBytes);
  ::fcntl(reading_end_, F_SETFL, O_NONBLOCK);
  finish_event_ = ::eventfd(0, EFD_CLOEXEC);
}

ProcessOutput::~ProcessOutput() {
  finish();
  close_writing_end();
  close_descriptor(reading_end_);
  close_descriptor(finish_event_);
}

void ProcessOutput::close_writing_end() { close_descriptor(writing_end_); }

void ProcessOutput::write_to(const std::filesystem::path& file) {
  file_ = ::open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (file_ < 0) throw InputError(fmt::format("{}: cannot be written: {}", file.string(), std::strerror(errno)));
  thread_ = std::thread([this] { copy_until_finished(); });
}

void ProcessOutput::copy_until_finished() {
  std::array<pollfd, 2> waiting = {pollfd{.fd = reading_end_, .events = POLLIN, .revents = 0},
                                   pollfd{.fd = finish_event_, .events = POLLIN, .revents = 0}};
  while (waiting[1].revents == 0) {
    if (::poll(waiting.data(), waiting.size(), -1) < 0 && errno != EINTR) return;
    if (!copy_available(reading_end_, file_)) return;
  }
}

void ProcessOutput::finish() {
  if (!thread_.joinable()) return;
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = ::write(finish_event_, &one, sizeof(one));
  thread_.join();
  close_descriptor(file_);
}

}  // namespace patrol::link
