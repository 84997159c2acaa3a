#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

struct gzFile_s;  // type of zlib

namespace patrol::io {

/// Sequential reader of the lines of a text file, plain or gzip-compressed. Memory is bounded by one line of maximum
/// length plus a buffer, whatever the file contains.
class LineReader {
 public:
  /// Maximum length of a line; longer lines are truncated and marked.
  static constexpr std::size_t kMaxLineBytes = std::size_t{1} << 20;

  struct Line {
    int number = 0;         ///< starts at 1
    std::string_view text;  ///< text without the line end; valid until the next call
    bool is_cut = false;    ///< true: the line was longer than kMaxLineBytes
  };

  /// Opens a file. Throws InputError if it is missing or cannot be read.
  explicit LineReader(const std::filesystem::path& file);

  /// Returns the next line; nullopt at the end. Throws InputError on a read error of the disk.
  std::optional<Line> next();

  /// Reason why reading ended before the end of the file (truncated gzip data, endless line). Valid after the last
  /// line.
  const std::optional<std::string>& read_error() const { return read_error_; }

  /// Returns the fraction of the file read, in bytes on disk, 0 to 1.
  double progress() const;
  const std::filesystem::path& file() const { return file_; }

 private:
  bool fill();
  void drop_rest_of_line();
  std::optional<Line> take(std::size_t size, std::size_t end_size);

  struct Close {
    void operator()(gzFile_s* file) const;
  };

  std::filesystem::path file_;
  std::unique_ptr<gzFile_s, Close> gzip_;
  double size_ = 0.0;  ///< size of the file, bytes
  std::vector<char> buffer_;
  std::size_t begin_ = 0, end_ = 0;  ///< range of unread bytes in the buffer
  int number_ = 0;
  bool is_inside_cut_line_ = false;
  bool is_at_end_ = false;
  std::optional<std::string> read_error_;
};

}  // namespace patrol::io
