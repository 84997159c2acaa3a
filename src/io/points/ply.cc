#include "io/points/ply.h"

#include <bit>
#include <map>
#include <string_view>

#include <fmt/format.h>

#include "io/files/atomic_file.h"
#include "io/files/line_tokenizer.h"
#include "io/points/point_reading.h"
#include "io/points/point_table.h"

namespace patrol::io {
namespace {

constexpr std::int64_t kMaxPlyPoints = 1'000'000'000;
constexpr std::size_t kMaxPlyProperties = 1000;

const std::map<std::string_view, NumberType> kPlyTypes = {
    {"char", NumberType::kInt8},      {"int8", NumberType::kInt8},       {"uchar", NumberType::kUint8},
    {"uint8", NumberType::kUint8},    {"short", NumberType::kInt16},     {"int16", NumberType::kInt16},
    {"ushort", NumberType::kUint16},  {"uint16", NumberType::kUint16},   {"int", NumberType::kInt32},
    {"int32", NumberType::kInt32},    {"uint", NumberType::kUint32},     {"uint32", NumberType::kUint32},
    {"float", NumberType::kFloat32},  {"float32", NumberType::kFloat32}, {"double", NumberType::kFloat64},
    {"float64", NumberType::kFloat64}};

constexpr const char* kBigEndian = "binary_big_endian";

struct PlyHeader {
  std::string format;
  std::size_t num_points = 0;
  std::vector<PointColumn> columns;
  int num_elements = 0;
  std::int64_t num_faces = 0;
};

PointColumn read_property(FileText& text, LineTokenizer& fields) {
  const std::string type(fields.word("type"));
  if (type == "list") text.refuse("list properties of vertex are not supported");
  const auto known = kPlyTypes.find(type);
  if (known == kPlyTypes.end()) text.refuse("property of unknown type");
  return {.name = std::string(fields.word("name")), .type = known->second};
}

void read_element(FileText& text, LineTokenizer& fields, PlyHeader& header) {
  const std::string_view name = fields.word("name");
  const std::int64_t count = fields.integer("count", 0, kMaxPlyPoints);
  if (name == "face") header.num_faces = count;
  if (header.num_elements++ > 0) return;
  if (name != "vertex") text.refuse("the first element must be vertex");
  header.num_points = static_cast<std::size_t>(count);
}

/// Reads a line of the header; returns true at its last line.
bool read_header_line(FileText& text, std::string_view line, PlyHeader& header) {
  LineTokenizer fields(line);
  if (fields.is_empty()) return false;
  const std::string key(fields.word("key"));
  if (key == "end_header") return true;
  if (key == "format") {
    header.format = fields.word("format");
  } else if (key == "element") {
    read_element(text, fields, header);
  } else if (key == "property") {
    if (header.num_elements == 0) text.refuse("property before the first element");
    if (header.num_elements > 1) return false;
    if (header.columns.size() >= kMaxPlyProperties)
      text.refuse(fmt::format("vertex has more than {} properties", kMaxPlyProperties));
    header.columns.push_back(read_property(text, fields));
  } else if (key != "comment" && key != "obj_info") {
    text.refuse("is not a line of a PLY header");
  }
  return false;
}

PlyHeader read_ply_header(FileText& text) {
  if (text.next_line() != "ply") text.refuse("is not a PLY file");
  PlyHeader header;
  for (bool is_over = false; !is_over;) {
    const auto line = text.next_line();
    if (!line) text.refuse("the header is incomplete");
    try {
      is_over = read_header_line(text, *line, header);
    } catch (const ParseError& error) {
      text.refuse(error.what());
    }
  }
  if (header.num_elements == 0) text.refuse("the header contains no element");
  if (header.format != "ascii" && header.format != "binary_little_endian" && header.format != kBigEndian) {
    text.refuse("unsupported format (known: ascii, binary_little_endian, binary_big_endian)");
  }
  return header;
}

std::vector<ScannerPoint> read_ply_points(const std::filesystem::path& file, PointShift* shift) {
  FileText text(file);
  PlyHeader header = read_ply_header(text);
  PointTable table(text, std::move(header.columns), header.num_points, shift);
  const std::endian order = header.format == kBigEndian ? std::endian::big : std::endian::little;
  std::vector<ScannerPoint> points = header.format == "ascii" ? table.read_ascii() : table.read_binary(order);
  if (header.num_elements == 1) table.expect_end();
  return points;
}

}  // namespace

void save_ply(const std::filesystem::path& file, const std::vector<ScannerPoint>& points, const std::string& comment) {
  std::string text = "ply\nformat binary_little_endian 1.0\n";
  if (!comment.empty()) text += fmt::format("comment {}\n", comment);
  text += fmt::format(
      "element vertex {}\nproperty float x\nproperty float y\nproperty float z\nproperty float intensity\nend_header\n",
      points.size());
  save_text(file, text + to_rows(points));
}

std::vector<ScannerPoint> load_ply(const std::filesystem::path& file) { return read_ply_points(file, nullptr); }

std::vector<ScannerPoint> load_shifted_ply(const std::filesystem::path& file, PointShift& shift) {
  return read_ply_points(file, &shift);
}

bool has_faces(const std::filesystem::path& ply_file) {
  FileText text(ply_file);
  return read_ply_header(text).num_faces > 0;
}

}  // namespace patrol::io
