#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/sensors/registry.h"

/// Common part of PLY and PCD: a header of text lines, followed by a table of numbers whose columns it names.
namespace patrol::io {

enum class NumberType : std::uint8_t {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat32,
  kFloat64
};

std::size_t bytes_of(NumberType type);

struct PointColumn {
  std::string name;
  NumberType type = NumberType::kFloat32;
  std::size_t count = 1;  ///< number of consecutive values
};

/// File in memory whose header is read line by line.
class FileText {
 public:
  /// Reads a file. Throws InputError if it is missing or larger than 4 GB.
  explicit FileText(const std::filesystem::path& file);

  /// Returns the next line without its end; nullopt at the end of the file.
  std::optional<std::string_view> next_line();
  std::string_view rest() const { return std::string_view(text_).substr(begin_); }
  /// Throws InputError with file and line.
  [[noreturn]] void refuse(const std::string& what) const;
  const std::string& file() const { return file_; }

 private:
  std::string file_, text_;
  std::size_t begin_ = 0;
  int line_ = 0;
};

/// Shift of the points to an origin, in double precision.
struct PointShift {
  std::optional<Eigen::Vector3d> origin;  ///< none: set by the first finite point (io/points/point_reading.h)
  std::size_t num_dropped = 0;            ///< number of points that are not finite, which are left out
  double unit_m = 1.0;                    ///< meters per unit of the file
  bool is_single_precision = false;       ///< the file has floats of 32 bits
};

/// Returns zero for a position within 10 km of zero on each axis, else the position rounded to 100 m; both in units of
/// the file.
Eigen::Vector3d origin_of(const Eigen::Vector3d& first, double unit_m = 1.0);

/// Reader of x, y, z and intensity (0 if missing) from rows of columns, little-endian binary or ASCII. All rows must be
/// complete, and without a shift all four values finite.
class PointTable {
 public:
  /// Throws InputError through `text` if x, y or z is missing or duplicate.
  PointTable(FileText& text, std::vector<PointColumn> columns, std::size_t num_points, PointShift* shift = nullptr);

  std::vector<ScannerPoint> read_binary(std::endian order = std::endian::little);
  std::vector<ScannerPoint> read_ascii();
  /// Throws InputError if non-blank data remain.
  void expect_end() const;

 private:
  /// Appends a point; returns false if it is not finite and there is no shift.
  bool append(std::array<double, 4> numbers, std::vector<ScannerPoint>& points);

  FileText& text_;
  PointShift* shift_;
  std::vector<PointColumn> columns_;
  std::size_t num_points_;
  std::size_t row_bytes_ = 0, row_numbers_ = 0;
  struct Source {
    std::size_t byte, number;  ///< within a row
    NumberType type;
  };
  std::optional<Source> sources_[4];  ///< columns of x, y, z, intensity
  std::size_t num_bytes_read_ = 0;
};

/// Formats rows for writing: x, y, z and intensity as little-endian floats.
std::string to_rows(const std::vector<ScannerPoint>& points);

}  // namespace patrol::io
