#pragma once

#include <cstddef>
#include <string>

namespace patrol::monitor {

/// Log that is written to a file descriptor, one line per call. Writing never throws and never waits: lines that cannot be written (closed,
/// full, or a pipe that is not read) are counted, and the next line that can be written is preceded by their number. Not thread-safe.
///
/// The process must ignore SIGPIPE (`survive_lost_output`).
class LineLog {
 public:
  explicit LineLog(int descriptor) : descriptor_(descriptor) {}

  /// Control characters are written out; a line has at most 500 bytes of text.
  void write(const std::string& text) noexcept;
  /// The same, after the time of the computer's clock.
  void write_with_time(const std::string& text) noexcept;
  std::size_t num_lost() const { return num_lost_; }

 private:
  bool write_bytes(const std::string& bytes) const;

  int descriptor_;
  std::size_t num_lost_ = 0;
};

/// Ignores SIGPIPE, and opens /dev/null in place of standard streams that are closed: a socket or the database would otherwise get their
/// numbers, and log lines with them.
void survive_lost_output();

}  // namespace patrol::monitor
