#include "io/files/line_reader.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <string_view>

#include <fmt/format.h>
#include <zlib.h>

#include "core/error.h"

namespace patrol::io {
namespace {

constexpr unsigned kGzipBufferBytes = 1U << 16;
constexpr std::size_t kReadBytes = std::size_t{1} << 15;
/// Maximum length of a skipped line; longer runs, such as zeros of a damaged disk, end the reading.
constexpr std::size_t kMaxDroppedBytes = std::size_t{1} << 26;

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  ///< byte order mark of UTF-8; some editors write it

}  // namespace

void LineReader::Close::operator()(gzFile_s* file) const { gzclose_r(file); }

LineReader::LineReader(const std::filesystem::path& file) : file_(file), buffer_(2 * kReadBytes) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) throw InputError(file.string() + ": file not found");
  const bool is_file = std::filesystem::is_regular_file(file, error);
  if (is_file) gzip_.reset(gzopen(file.c_str(), "rb"));
  if (!gzip_) throw InputError(file.string() + ": cannot be read");
  gzbuffer(gzip_.get(), kGzipBufferBytes);
  size_ = static_cast<double>(std::filesystem::file_size(file, error));
}

double LineReader::progress() const {
  if (is_at_end_ || size_ <= 0.0) return 1.0;
  return std::min(1.0, static_cast<double>(gzoffset(gzip_.get())) / size_);
}

/// Appends data to the buffer; returns false at the end of the file.
bool LineReader::fill() {
  if (is_at_end_) return false;
  if (begin_ > 0 && end_ + kReadBytes > buffer_.size()) {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
  }
  // A long line; the size stays bounded by kMaxLineBytes.
  if (end_ + kReadBytes > buffer_.size()) buffer_.resize(2 * buffer_.size());
  const int got = gzread(gzip_.get(), buffer_.data() + end_, static_cast<unsigned>(kReadBytes));
  if (got > 0) {
    end_ += static_cast<std::size_t>(got);
    return true;
  }
  is_at_end_ = true;
  int error = Z_OK;
  gzerror(gzip_.get(), &error);
  if (error == Z_ERRNO) throw InputError(fmt::format("{}:{}: read error", file_.string(), number_ + 1));
  if (error == Z_BUF_ERROR) read_error_ = "the gzip data are cut off";
  else if (error != Z_OK) read_error_ = "the gzip data are damaged";
  return false;
}

void LineReader::drop_rest_of_line() {
  is_inside_cut_line_ = false;
  std::size_t dropped = 0;
  while (begin_ < end_ || fill()) {
    const void* const newline = std::memchr(buffer_.data() + begin_, '\n', end_ - begin_);
    if (newline) {
      begin_ = static_cast<std::size_t>(static_cast<const char*>(newline) - buffer_.data()) + 1;
      return;
    }
    dropped += end_ - begin_;
    begin_ = end_ = 0;
    if (dropped > kMaxDroppedBytes) {
      read_error_ = fmt::format("more than {} bytes have no line's end, nothing is read", kMaxDroppedBytes);
      is_at_end_ = true;
    }
  }
}

std::optional<LineReader::Line> LineReader::take(std::size_t size, std::size_t end_size) {
  std::string_view text(buffer_.data() + begin_, size);
  begin_ += size + end_size;
  if (number_ == 0 && text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  if (number_ < std::numeric_limits<int>::max()) ++number_;
  return Line{.number = number_, .text = text, .is_cut = is_inside_cut_line_};
}

std::optional<LineReader::Line> LineReader::next() {
  if (is_inside_cut_line_) drop_rest_of_line();
  std::size_t searched = 0;
  while (true) {
    const char* const from = buffer_.data() + begin_ + searched;
    const void* const newline = std::memchr(from, '\n', end_ - begin_ - searched);
    searched += newline ? static_cast<std::size_t>(static_cast<const char*>(newline) - from) : end_ - begin_ - searched;
    if (searched > kMaxLineBytes) {
      is_inside_cut_line_ = true;
      return take(kMaxLineBytes, 0);
    }
    if (newline) return take(searched, 1);
    if (!fill()) break;
  }
  return searched > 0 ? take(searched, 0) : std::nullopt;
}

}  // namespace patrol::io
