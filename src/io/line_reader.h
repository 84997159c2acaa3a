#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

struct gzFile_s;  // zlib's

namespace patrol::io {

/// The lines of a text file, plain or in gzip, one after the other. Whatever the file holds, no more than a line's most bytes and a
/// buffer are in memory.
class LineReader {
 public:
  /// A longer line comes cut to this: it is none of a log's.
  static constexpr std::size_t kMaxLineBytes = std::size_t{1} << 20;

  struct Line {
    int number = 0;         ///< from 1
    std::string_view text;  ///< without its end; lives until the next call
    bool is_cut = false;    ///< the line is longer
  };

  /// Throws InputError when there is no such file, or it cannot be read.
  explicit LineReader(const std::filesystem::path& file);

  /// None at the end. Throws InputError when the disk fails.
  std::optional<Line> next();

  /// Why the lines ended before the file ("the gzip data are cut off"; a line that goes on and on); known once the last was read.
  const std::optional<std::string>& damage() const { return damage_; }

  /// Share of the file (as it lies on the disk) that was read, 0 ... 1.
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
  double size_ = 0.0;  ///< of the file, bytes
  std::vector<char> buffer_;
  std::size_t begin_ = 0, end_ = 0;  ///< of what is in the buffer and not yet given out
  int number_ = 0;
  bool is_inside_cut_line_ = false;
  bool is_at_end_ = false;
  std::optional<std::string> damage_;
};

}  // namespace patrol::io
