#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/sensors/registry.h"

/// What PLY and PCD have in common: a header of lines, and under it a table of numbers whose columns it names.
namespace patrol::io {

enum class NumberType : std::uint8_t { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kInt64, kUint64, kFloat32, kFloat64 };

std::size_t bytes_of(NumberType type);

struct PointColumn {
  std::string name;
  NumberType type = NumberType::kFloat32;
  std::size_t count = 1;  ///< of numbers, one after the other
};

/// A file in memory, taken line by line as long as it is text.
class FileText {
 public:
  /// Throws InputError when there is no such file, or it is larger than 4 GB.
  explicit FileText(const std::filesystem::path& file);

  /// The next line without its end; none at the end of the file.
  std::optional<std::string_view> next_line();
  std::string_view rest() const { return std::string_view(text_).substr(begin_); }
  /// Throws InputError that names file and line.
  [[noreturn]] void refuse(const std::string& what) const;
  const std::string& file() const { return file_; }

 private:
  std::string file_, text_;
  std::size_t begin_ = 0;
  int line_ = 0;
};

/// Takes x, y, z and intensity (0 where there is none) out of rows of columns, little-endian or in figures; each row must be there
/// and all four must be finite.
class PointTable {
 public:
  /// Throws InputError, through `text`, when x, y or z is missing or stands there twice.
  PointTable(FileText& text, std::vector<PointColumn> columns, std::size_t num_points);

  std::vector<ScannerPoint> read_binary();
  std::vector<ScannerPoint> read_figures();
  /// Throws InputError when something is left that is no blank.
  void expect_end() const;

 private:
  FileText& text_;
  std::vector<PointColumn> columns_;
  std::size_t num_points_;
  std::size_t row_bytes_ = 0, row_numbers_ = 0;
  struct Source {
    std::size_t byte, number;  ///< within a row
    NumberType type;
  };
  std::optional<Source> sources_[4];  ///< of x, y, z, intensity
  std::size_t num_bytes_read_ = 0;
};

/// The rows of a file of ours: x, y, z and intensity as floats, little-endian.
std::string to_rows(const std::vector<ScannerPoint>& points);

}  // namespace patrol::io
