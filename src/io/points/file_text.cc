#include "io/points/file_text.h"

#include <algorithm>
#include <cstdint>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "io/files/atomic_file.h"

namespace patrol::io {
namespace {

constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{4} << 30;

}  // namespace

FileText::FileText(const std::filesystem::path& file) : file_(file.string()) {
  std::error_code is_no_file;  // set if there is no file; the size is then undefined
  if (const std::uintmax_t size = std::filesystem::file_size(file, is_no_file); !is_no_file && size > kMaxFileBytes) {
    throw InputError(fmt::format("{}: is larger than {} bytes", file_, kMaxFileBytes));
  }
  text_ = load_text(file);
}

std::optional<std::string_view> FileText::next_line() {
  if (begin_ >= text_.size()) return std::nullopt;
  ++line_;
  const std::size_t end = std::min(text_.find('\n', begin_), text_.size());
  std::string_view line = std::string_view(text_).substr(begin_, end - begin_);
  begin_ = std::min(end + 1, text_.size());
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

void FileText::refuse(const std::string& what) const { throw input_error(file_, line_, what); }

void FileText::replace_rest(std::string bytes) {
  text_ = std::move(bytes);
  begin_ = 0;
}

}  // namespace patrol::io
