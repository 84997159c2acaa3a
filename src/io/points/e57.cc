#include "io/points/e57.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <tinyxml2.h>

#include "core/error.h"
#include "io/files/xml_problem.h"
#include "io/points/e57_column.h"
#include "io/points/e57_file.h"
#include "io/points/point_collector.h"

namespace patrol::io {
namespace {

using tinyxml2::XMLElement;

/// Returns the number of a text without blanks around it; none if it is no number.
template <typename Number>
std::optional<Number> e57_number(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return std::nullopt;
  text = text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && end == text.data() + text.size() ? std::optional(number) : std::nullopt;
}

/// Reader of an element of /data3D.
class E57ScanReader {
 public:
  E57ScanReader(const E57File& file, const XMLElement& scan, std::size_t index)
      : file_(file), scan_(scan), name_(fmt::format("scan_{}", index + 1)), path_(fmt::format("/data3D/{}", index)) {}

  const std::string& name() const { return name_; }

  bool has_pose() const { return scan_.FirstChildElement("pose") != nullptr; }

  /// Returns the pose of the frame of the scan in the frame of the file; the identity if there is none.
  Pose3 pose() const {
    const XMLElement* pose = scan_.FirstChildElement("pose");
    const XMLElement* rotation = pose == nullptr ? nullptr : pose->FirstChildElement("rotation");
    const XMLElement* translation = pose == nullptr ? nullptr : pose->FirstChildElement("translation");
    Pose3 T;
    if (translation != nullptr)
      T.position = {child(*translation, "x"), child(*translation, "y"), child(*translation, "z")};
    if (rotation != nullptr) {
      const Eigen::Quaterniond q(child(*rotation, "w"), child(*rotation, "x"), child(*rotation, "y"),
                                 child(*rotation, "z"));
      if (!(std::abs(q.norm() - 1.0) < 1e-3)) file_.refuse(path_ + "/pose/rotation", "is not a unit quaternion");
      T.rotation = q.normalized();
    }
    return T;
  }

  /// Returns the element of the points; null for a scan without points.
  const XMLElement* points() const { return scan_.FirstChildElement("points"); }
  std::string points_path() const { return path_ + "/points"; }

  std::uint64_t attribute(const char* name) const {
    const char* text = points()->Attribute(name);
    const auto number = e57_number<std::uint64_t>(text == nullptr ? "" : text);
    if (!number) file_.refuse(points_path(), fmt::format("{} must be a number of 0 or more", name));
    return *number;
  }

  /// Returns the fields of a point, in the order of the prototype.
  std::vector<E57Column> columns() const {
    const XMLElement* prototype = points()->FirstChildElement("prototype");
    if (prototype == nullptr) file_.refuse(points_path(), "has no prototype");
    check_codecs();
    std::vector<E57Column> columns;
    add_columns(*prototype, columns);
    return columns;
  }

 private:
  /// Returns the number of a child element. One that is missing or empty is 0, by the standard.
  double child(const XMLElement& parent, const char* name) const {
    const XMLElement* element = parent.FirstChildElement(name);
    const char* text = element == nullptr ? nullptr : element->GetText();
    if (text == nullptr) return 0.0;
    const auto number = e57_number<double>(text);
    if (!number || !std::isfinite(*number))
      file_.refuse(fmt::format("{}/pose/{}/{}", path_, parent.Name(), name), "must be a finite number");
    return *number;
  }

  void check_codecs() const {
    const XMLElement* codecs = points()->FirstChildElement("codecs");
    if (codecs == nullptr) return;
    for (const XMLElement* codec = codecs->FirstChildElement(); codec != nullptr; codec = codec->NextSiblingElement()) {
      for (const XMLElement* kind = codec->FirstChildElement(); kind != nullptr; kind = kind->NextSiblingElement()) {
        const std::string_view name = kind->Name();
        if (name != "inputs" && name != "bitPackCodec")
          file_.refuse(points_path() + "/codecs", fmt::format("{} is not supported (known: bitPackCodec)", name));
      }
    }
  }

  void add_columns(const XMLElement& parent, std::vector<E57Column>& columns) const {
    for (const XMLElement* field = parent.FirstChildElement(); field != nullptr; field = field->NextSiblingElement()) {
      const char* type = field->Attribute("type");
      const std::string_view kind = type == nullptr ? "" : type;
      if (kind == "Structure" || kind == "Vector") {
        add_columns(*field, columns);
      } else {
        columns.push_back(column(*field, kind));
      }
    }
  }

  E57Column column(const XMLElement& field, std::string_view kind) const {
    E57Column column{.name = field.Name()};
    if (kind == "Float") {
      const bool is_single = field.Attribute("precision", "single") != nullptr;
      column.type = is_single ? E57Type::kFloat32 : E57Type::kFloat64;
      column.bits = is_single ? 32 : 64;
    } else if (kind == "Integer" || kind == "ScaledInteger") {
      column.type = E57Type::kInteger;
      column.minimum = limit(field, "minimum", std::numeric_limits<std::int64_t>::min());
      const std::int64_t maximum = limit(field, "maximum", std::numeric_limits<std::int64_t>::max());
      if (maximum < column.minimum) file_.refuse(field_path(field), "maximum is less than minimum");
      column.bits = static_cast<std::size_t>(
          std::bit_width(static_cast<std::uint64_t>(maximum) - static_cast<std::uint64_t>(column.minimum)));
      if (kind == "ScaledInteger") {
        column.scale = real(field, "scale", 1.0);
        column.offset = real(field, "offset", 0.0);
      }
    } else if (kind == "String") {
      column.type = E57Type::kText;
    } else {
      file_.refuse(field_path(field), fmt::format("type '{}' is not supported", kind));
    }
    return column;
  }

  std::string field_path(const XMLElement& field) const {
    return fmt::format("{}/prototype/{}", points_path(), field.Name());
  }

  std::int64_t limit(const XMLElement& field, const char* name, std::int64_t fallback) const {
    const char* text = field.Attribute(name);
    if (text == nullptr) return fallback;
    const auto number = e57_number<std::int64_t>(text);
    if (!number) file_.refuse(field_path(field), fmt::format("{} must be an integer", name));
    return *number;
  }

  double real(const XMLElement& field, const char* name, double fallback) const {
    const char* text = field.Attribute(name);
    if (text == nullptr) return fallback;
    const auto number = e57_number<double>(text);
    if (!number || !std::isfinite(*number))
      file_.refuse(field_path(field), fmt::format("{} must be a finite number", name));
    return *number;
  }

  const E57File& file_;
  const XMLElement& scan_;
  std::string name_, path_;
};

/// Columns of a scan that make its points.
struct PointColumns {
  std::array<const E57Column*, 3> coordinates = {};  ///< x, y, z, or range, azimuth and elevation
  const E57Column* intensity = nullptr;              ///< null: none
  const E57Column* invalid = nullptr;                ///< state that is not 0 for a point without a position; null: none
  bool is_spherical = false;

  Eigen::Vector3d position(std::size_t record) const {
    const Eigen::Vector3d p(coordinates[0]->number(record), coordinates[1]->number(record),
                            coordinates[2]->number(record));
    if (!is_spherical) return p;
    const double level = p[0] * std::cos(p[2]);
    return {level * std::cos(p[1]), level * std::sin(p[1]), p[0] * std::sin(p[2])};
  }
};

constexpr std::array<std::string_view, 3> kCartesian = {"cartesianX", "cartesianY", "cartesianZ"};
constexpr std::array<std::string_view, 3> kSpherical = {"sphericalRange", "sphericalAzimuth", "sphericalElevation"};

const E57Column* column_of(const std::vector<E57Column>& columns, std::string_view name) {
  const auto found = std::ranges::find_if(
      columns, [&](const E57Column& column) { return column.name == name && column.type != E57Type::kText; });
  return found == columns.end() ? nullptr : &*found;
}

bool has_columns(const std::vector<E57Column>& columns, const std::array<std::string_view, 3>& names) {
  return std::ranges::all_of(names, [&](std::string_view name) { return column_of(columns, name) != nullptr; });
}

/// Cartesian coordinates come before spherical ones.
PointColumns point_columns(const std::vector<E57Column>& columns) {
  PointColumns result{.is_spherical = !has_columns(columns, kCartesian)};
  const auto& names = result.is_spherical ? kSpherical : kCartesian;
  for (std::size_t i = 0; i < names.size(); ++i) result.coordinates[i] = column_of(columns, names[i]);
  result.intensity = column_of(columns, "intensity");
  result.invalid = column_of(columns, result.is_spherical ? "sphericalInvalidState" : "cartesianInvalidState");
  return result;
}

void parse(const std::filesystem::path& file, std::string_view xml, tinyxml2::XMLDocument& document) {
  if (document.Parse(xml.data(), xml.size()) != tinyxml2::XML_SUCCESS) {
    throw InputError(
        fmt::format("{}: XML section, line {}: {}", file.string(), document.ErrorLineNum(), xml_problem(document)));
  }
  if (document.FirstChildElement("e57Root") == nullptr)
    throw InputError(file.string() + ": XML section: has no e57Root");
}

/// Returns the columns of the points of a scan with their bytes.
std::vector<E57Column> read_columns(const E57File& file, const E57ScanReader& reader, std::uint64_t num_records) {
  std::vector<E57Column> columns = reader.columns();
  if (!has_columns(columns, kCartesian) && !has_columns(columns, kSpherical))
    file.refuse(reader.points_path(), "has neither cartesian nor spherical coordinates");
  const PointColumns used = point_columns(columns);
  for (E57Column& column : columns) {
    column.is_needed = &column == used.intensity || &column == used.invalid ||
                       std::ranges::find(used.coordinates, &column) != used.coordinates.end();
  }
  read_e57_columns(file, reader.attribute("fileOffset"), num_records, reader.points_path(), columns);
  return columns;
}

/// Adds the points of a scan, if it has any. `max_records`: of the scan; reduced by its number.
void add_scan(const E57File& file, const E57ScanReader& reader, std::uint64_t& max_records, PointShift& shift,
              E57Scans& result) {
  const std::uint64_t num_records = reader.points() == nullptr ? 0 : reader.attribute("recordCount");
  if (num_records == 0) return;
  if (num_records > max_records)
    file.refuse(reader.points_path(), fmt::format("the file is too short for {} points", num_records));
  max_records -= num_records;
  const std::vector<E57Column> columns = read_columns(file, reader, num_records);
  const PointColumns used = point_columns(columns);
  if (!reader.has_pose() && !used.is_spherical && column_of(columns, "rowIndex") == nullptr)
    result.has_scanners = false;
  const Pose3 T_file_scan = reader.pose();
  PointCollector points(&shift);
  points.reserve(num_records);
  double largest = 0.0;  // coordinate
  for (std::size_t i = 0; i < num_records; ++i) {
    if (used.invalid != nullptr && used.invalid->number(i) != 0.0) {
      ++shift.num_dropped;
      continue;
    }
    const Eigen::Vector3d p_scan = used.position(i), p = T_file_scan * p_scan;
    const double intensity = used.intensity == nullptr ? 0.0 : used.intensity->number(i);
    if (!points.add({p.x(), p.y(), p.z(), intensity}))
      file.refuse(reader.points_path(), fmt::format("point {} is too far away", i));
    if (p_scan.allFinite()) largest = std::max(largest, p_scan.cwiseAbs().maxCoeff());
  }
  if (used.coordinates[0]->type == E57Type::kFloat32)
    result.step = std::max(result.step, static_cast<double>(std::numeric_limits<float>::epsilon()) * largest);
  result.scans.scans.push_back({.station = reader.name(), .T_map_scanner = T_file_scan, .points = points.take()});
}

}  // namespace

E57Scans load_e57(const std::filesystem::path& file, double unit_m) {
  const E57File content(file);
  tinyxml2::XMLDocument document;
  parse(file, content.xml(), document);
  PointShift shift{.origin = {}, .num_dropped = 0, .unit_m = unit_m};
  std::uint64_t max_records = 8 * content.num_bytes();  // a record has at least one bit
  E57Scans result;
  const XMLElement* list = document.FirstChildElement("e57Root")->FirstChildElement("data3D");
  const XMLElement* scan = list == nullptr ? nullptr : list->FirstChildElement();
  for (std::size_t index = 0; scan != nullptr; ++index, scan = scan->NextSiblingElement())
    add_scan(content, E57ScanReader(content, *scan, index), max_records, shift, result);
  if (shift.origin) result.scans.origin = *shift.origin;
  for (StationScan& relative : result.scans.scans) relative.T_map_scanner.position -= result.scans.origin;
  result.scans.num_dropped = shift.num_dropped;
  return result;
}

RelativePoints joined_points(E57Scans scans) {
  RelativePoints joined{
      .origin = scans.scans.origin, .points = {}, .num_dropped = scans.scans.num_dropped, .step = scans.step};
  for (StationScan& scan : scans.scans.scans) {
    joined.points.insert(joined.points.end(), scan.points.begin(), scan.points.end());
    scan.points = {};
  }
  return joined;
}

}  // namespace patrol::io
