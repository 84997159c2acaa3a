#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/sensors/registry.h"
#include "io/points/file_text.h"
#include "io/points/point_collector.h"

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
  FileText& text_;
  PointShift* shift_;
  std::vector<PointColumn> columns_;
  std::size_t num_points_;
  std::size_t row_bytes_ = 0, row_numbers_ = 0;
  struct Source {
    std::size_t byte, number;  ///< offsets of the byte and of the number within a row
    NumberType type;
  };
  std::optional<Source> sources_[4];  ///< columns of x, y, z, intensity
  std::size_t num_bytes_read_ = 0;
};

/// Formats rows for writing: x, y, z and intensity as little-endian floats.
std::string to_rows(const std::vector<ScannerPoint>& points);

}  // namespace patrol::io
