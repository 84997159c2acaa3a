#include "io/points/pcd.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <lzf.h>

#include "core/error.h"
#include "io/files/atomic_file.h"
#include "io/files/line_tokenizer.h"
#include "io/points/point_table.h"

namespace patrol::io {
namespace {

constexpr std::int64_t kMaxPcdPoints = 1'000'000'000;
constexpr std::size_t kMaxPcdFields = 1000;
constexpr std::int64_t kMaxFieldCount = 100'000;
constexpr const char* kCompressed = "binary_compressed";

struct PcdHeader {
  std::vector<PointColumn> columns;
  std::vector<std::size_t> sizes;  ///< [column], bytes
  std::string types;               ///< [column]: I, U or F
  std::int64_t width = 0, height = 1;
  std::optional<std::int64_t> points;
  std::string data;
};

void read_values(FileText& text, const std::string& key, LineTokenizer& fields, PcdHeader& header) {
  if (key == "FIELDS") {
    if (fields.num_words() > kMaxPcdFields) text.refuse(fmt::format("FIELDS has more than {} words", kMaxPcdFields));
    while (!fields.is_empty()) header.columns.push_back({.name = std::string(fields.word("name"))});
  } else if (key == "SIZE") {
    while (!fields.is_empty()) header.sizes.push_back(static_cast<std::size_t>(fields.integer("SIZE", 1, 8)));
  } else if (key == "TYPE") {
    while (!fields.is_empty()) header.types += fields.word("type").front();
  } else if (key == "COUNT") {
    for (std::size_t i = 0; !fields.is_empty(); ++i) {
      if (i >= header.columns.size()) text.refuse("COUNT has more words than FIELDS");
      header.columns[i].count = static_cast<std::size_t>(fields.integer("COUNT", 1, kMaxFieldCount));
    }
  } else if (key == "WIDTH") {
    header.width = fields.integer("WIDTH", 0, kMaxPcdPoints);
  } else if (key == "HEIGHT") {
    header.height = fields.integer("HEIGHT", 0, kMaxPcdPoints);
  } else if (key == "POINTS") {
    header.points = fields.integer("POINTS", 0, kMaxPcdPoints);
  } else if (key == "DATA") {
    header.data = fields.word("DATA");
  } else if (key != "VERSION" && key != "VIEWPOINT") {
    text.refuse("is not a line of a PCD header");
  }
}

std::optional<NumberType> type_of(char type, std::size_t bytes) {
  if (type == 'F')
    return bytes == 4   ? std::optional(NumberType::kFloat32)
           : bytes == 8 ? std::optional(NumberType::kFloat64)
                        : std::nullopt;
  if (type != 'I' && type != 'U') return std::nullopt;
  for (const NumberType known : {NumberType::kInt8, NumberType::kInt16, NumberType::kInt32, NumberType::kInt64}) {
    if (bytes_of(known) != bytes) continue;
    // Each signed type is followed by its unsigned counterpart.
    return type == 'I' ? known : static_cast<NumberType>(static_cast<int>(known) + 1);
  }
  return std::nullopt;
}

void set_types(FileText& text, PcdHeader& header) {
  if (header.sizes.size() != header.columns.size() || header.types.size() != header.columns.size()) {
    text.refuse(fmt::format("FIELDS has {} words, SIZE {} and TYPE {}", header.columns.size(), header.sizes.size(),
                            header.types.size()));
  }
  for (std::size_t i = 0; i < header.columns.size(); ++i) {
    const auto type = type_of(header.types[i], header.sizes[i]);
    if (!type) text.refuse(fmt::format("TYPE and SIZE of field {} are inconsistent", i + 1));
    header.columns[i].type = *type;
  }
}

PcdHeader read_pcd_header(FileText& text) {
  PcdHeader header;
  while (header.data.empty()) {
    const auto line = text.next_line();
    if (!line) text.refuse("the header has no line DATA");
    LineTokenizer fields(*line);
    if (fields.is_empty() || line->front() == '#') continue;
    try {
      const std::string key(fields.word("key"));
      read_values(text, key, fields, header);
    } catch (const ParseError& error) {
      text.refuse(error.what());
    }
  }
  set_types(text, header);
  if (header.data != "ascii" && header.data != "binary" && header.data != kCompressed)
    text.refuse("DATA must be ascii, binary or binary_compressed");
  if (header.height > 0 && header.width > kMaxPcdPoints / header.height) text.refuse("WIDTH x HEIGHT is too large");
  const std::int64_t points = header.width * header.height;
  if (header.points.value_or(points) != points)
    text.refuse(fmt::format("POINTS is {}, WIDTH x HEIGHT {}", *header.points, points));
  return header;
}

/// Returns the rows of compressed data: two sizes, before and after LZF, then the values, column after column.
std::string decompressed_rows(const FileText& text, const PcdHeader& header) {
  constexpr std::size_t kMaxRatio = 88;  // of LZF: 264 bytes from 3
  const std::string_view rest = text.rest();
  std::array<std::uint32_t, 2> sizes{};
  if (rest.size() < sizeof sizes) throw InputError(fmt::format("{}: ends too early for compressed data", text.file()));
  std::memcpy(sizes.data(), rest.data(), sizeof sizes);
  const auto [packed_bytes, bytes] = sizes;
  std::size_t row_bytes = 0;
  for (const PointColumn& column : header.columns) row_bytes += column.count * bytes_of(column.type);
  const auto num_points = static_cast<std::size_t>(header.width * header.height);
  if (bytes != num_points * row_bytes) {
    throw InputError(fmt::format("{}: has {} bytes of compressed data, {} points of {} bytes need {}", text.file(),
                                 bytes, num_points, row_bytes, num_points * row_bytes));
  }
  if (packed_bytes > rest.size() - sizeof sizes || bytes > kMaxRatio * packed_bytes)
    throw InputError(fmt::format("{}: ends too early for compressed data", text.file()));
  std::string values(bytes, '\0');
  if (bytes > 0 && lzf_decompress(rest.data() + sizeof sizes, packed_bytes, values.data(), bytes) != bytes)
    throw InputError(fmt::format("{}: the compressed data are invalid", text.file()));
  std::string rows(bytes, '\0');
  const char* from = values.data();
  std::size_t begin = 0;  // of the column within a row
  for (const PointColumn& column : header.columns) {
    const std::size_t width = column.count * bytes_of(column.type);
    for (std::size_t i = 0; i < num_points; ++i, from += width) std::copy_n(from, width, &rows[i * row_bytes + begin]);
    begin += width;
  }
  return rows;
}

std::vector<ScannerPoint> read_pcd_points(const std::filesystem::path& file, PointShift* shift) {
  FileText text(file);
  PcdHeader header = read_pcd_header(text);
  if (header.data == kCompressed) text.replace_rest(decompressed_rows(text, header));
  PointTable table(text, std::move(header.columns), static_cast<std::size_t>(header.width * header.height), shift);
  std::vector<ScannerPoint> points = header.data == "ascii" ? table.read_ascii() : table.read_binary();
  table.expect_end();
  return points;
}

}  // namespace

void save_pcd(const std::filesystem::path& file, const std::vector<ScannerPoint>& points) {
  const std::string header = fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F "
      "F\nCOUNT 1 1 1 1\n"
      "WIDTH {0}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {0}\nDATA binary\n",
      points.size());
  save_text(file, header + to_rows(points));
}

std::vector<ScannerPoint> load_pcd(const std::filesystem::path& file) { return read_pcd_points(file, nullptr); }

std::vector<ScannerPoint> load_shifted_pcd(const std::filesystem::path& file, PointShift& shift) {
  return read_pcd_points(file, &shift);
}

}  // namespace patrol::io
