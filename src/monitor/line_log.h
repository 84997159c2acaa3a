#pragma once

#include <cstddef>
#include <string>

namespace patrol::monitor {

/// Log to a file descriptor, one line per call. Writing never throws and never blocks: lines that cannot be written
/// (closed, full, or a pipe without reader) are counted, and their number precedes the next written line. Not
/// thread-safe.
///
/// The process must ignore SIGPIPE (`ignore_lost_output`).
class LineLog {
 public:
  explicit LineLog(int descriptor) : descriptor_(descriptor) {}

  /// Writes a line of at most 500 bytes of text; control characters are escaped.
  void write(const std::string& text) noexcept;
  /// Writes a line with the current UTC time in front of the text.
  void write_with_time(const std::string& text) noexcept;
  std::size_t num_lost() const { return num_lost_; }

 private:
  bool write_bytes(const std::string& bytes) const;

  int descriptor_;
  std::size_t num_lost_ = 0;
};

/// Ignores SIGPIPE, and opens /dev/null for closed standard streams. Otherwise a socket or the database would get their
/// descriptors, and with them log lines.
void ignore_lost_output();

}  // namespace patrol::monitor
