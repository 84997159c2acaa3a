#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace patrol::io {

/// File in memory that is read line by line, as a whole or up to the end of its header.
class FileText {
 public:
  /// Reads a file. Throws InputError if it is missing or larger than 4 GB.
  explicit FileText(const std::filesystem::path& file);

  /// Returns the next line without its end; nullopt at the end of the file.
  std::optional<std::string_view> next_line();
  std::string_view rest() const { return std::string_view(text_).substr(begin_); }
  /// Replaces all that follows the current line.
  void replace_rest(std::string bytes);
  /// Throws InputError with file and line.
  [[noreturn]] void refuse(const std::string& what) const;
  const std::string& file() const { return file_; }

 private:
  std::string file_, text_;
  std::size_t begin_ = 0;
  int line_ = 0;
};

}  // namespace patrol::io
