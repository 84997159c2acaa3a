#include "io/logs/carmen_message.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "io/files/line_tokenizer.h"

namespace patrol::io {
namespace {

constexpr std::size_t kTailWords = 3;  ///< ipc_timestamp ipc_hostname logger_timestamp
constexpr std::size_t kPoseWords = 3;
constexpr std::size_t kDriveWords = 5;  ///< words of ROBOTLASERn: tv rv forward_safety_dist side_safety_dist turn_axis
constexpr double kMaxAngleRad = 7.0;    ///< one turn plus rounding

/// Checks the number of remaining words before any of them is interpreted.
void expect_word_count(const LineTokenizer& fields, std::size_t expected, const char* after) {
  const std::size_t words = fields.num_words();
  if (words != expected) throw ParseError(fmt::format("{} words after the {}: must be {}", words, after, expected));
}

std::size_t read_count(LineTokenizer& fields, const char* what, std::int64_t min) {
  return static_cast<std::size_t>(fields.integer(what, min, static_cast<std::int64_t>(kMaxCarmenBeams)));
}

/// Reads a counted list. The count is checked against the number of words in the line before memory is allocated.
template <typename Number>
std::vector<Number> read_numbers(LineTokenizer& fields, std::size_t count, const char* what) {
  const std::size_t words = fields.num_words();
  if (count > words) throw ParseError(fmt::format("{} words left for {} {}s: too few", words, count, what));
  std::vector<Number> numbers;
  numbers.reserve(count);
  for (std::size_t i = 0; i < count; ++i) numbers.push_back(static_cast<Number>(fields.any_number(what)));
  return numbers;
}

void read_poses(LineTokenizer& fields, CarmenScan& scan) {
  scan.T_odom_lidar = fields.pose("laser pose");
  scan.T_odom_body = fields.pose("robot pose");
}

/// Returns a refined angle increment. Angles in the file have six decimal digits, whose rounding adds up to hundredths
/// of a degree over a scan. The field of view is more accurate if it equals the number of beams, or of gaps between
/// them, times the step.
double exact_increment(double step_rad, double field_of_view_rad, std::size_t num_beams) {
  constexpr double kRoundingRad = 1e-3;
  const auto beams = static_cast<double>(num_beams);
  for (const double steps : {beams - 1.0, beams}) {
    if (steps > 0.0 && std::abs(step_rad * steps - field_of_view_rad) < kRoundingRad) return field_of_view_rad / steps;
  }
  return step_rad;
}

/// Reads a message of the new formats: laser_type start_angle field_of_view angular_resolution maximum_range accuracy
/// remission_mode num_readings ranges num_remissions remissions.
void read_new_scan(LineTokenizer& fields, CarmenScan& scan) {
  const auto angle = [&](const char* what) {
    const double value = fields.number(what);
    if (std::abs(value) > kMaxAngleRad)
      throw ParseError(fmt::format("{} = {} rad: exceeds one revolution", what, value));
    return value;
  };
  fields.number("laser_type");
  scan.angle_min_rad = angle("start_angle");
  const double field_of_view_rad = angle("field_of_view"), step_rad = angle("angular_resolution");
  const double range_max_m = fields.number("maximum_range");
  if (range_max_m > 0.0) scan.range_max_m = range_max_m;
  fields.number("accuracy");
  fields.number("remission_mode");
  const std::size_t num_beams = read_count(fields, "num_readings", 1);
  scan.angle_increment_rad = exact_increment(step_rad, field_of_view_rad, num_beams);
  if (num_beams > 1 && *scan.angle_increment_rad == 0.0)
    *scan.angle_increment_rad = field_of_view_rad / static_cast<double>(num_beams - 1);
  scan.ranges_m = read_numbers<double>(fields, num_beams, "range");
  scan.remissions = read_numbers<float>(fields, read_count(fields, "num_remissions", 0), "remission");
  if (scan.remissions.size() != scan.ranges_m.size()) scan.remissions.clear();
}

}  // namespace

std::optional<CarmenLaserFamily> carmen_laser_family(std::string_view name) {
  if (name == "FLASER" || name == "RLASER") return CarmenLaserFamily::kOld;
  if (name == "RAWLASER1" || name == "RAWLASER2") return CarmenLaserFamily::kRaw;
  if (name == "ROBOTLASER1" || name == "ROBOTLASER2") return CarmenLaserFamily::kRobot;
  return std::nullopt;
}

bool is_rear_laser(std::string_view name) { return name == "RLASER" || name.ends_with('2'); }

CarmenScan parse_carmen_scan(CarmenLaserFamily family, std::string_view contents) {
  LineTokenizer fields(contents);
  CarmenScan scan;
  if (family == CarmenLaserFamily::kOld) {
    const std::size_t num_beams = read_count(fields, "num_readings", 1);
    expect_word_count(fields, num_beams + 2 * kPoseWords + kTailWords, "number of readings");
    scan.ranges_m = read_numbers<double>(fields, num_beams, "range");
    read_poses(fields, scan);
  } else {
    read_new_scan(fields, scan);
    const bool has_poses = family == CarmenLaserFamily::kRobot;
    expect_word_count(fields, (has_poses ? 2 * kPoseWords + kDriveWords : 0) + kTailWords, "remissions");
    if (has_poses) {
      read_poses(fields, scan);
      for (std::size_t i = 0; i < kDriveWords; ++i) fields.any_number("drive value");
    }
  }
  scan.stamp = fields.stamp("ipc_timestamp");
  return scan;
}

CarmenOdometry parse_carmen_odometry(std::string_view contents) {
  LineTokenizer fields(contents);
  expect_word_count(fields, kPoseWords + 3 + kTailWords, "name");
  CarmenOdometry odometry;
  odometry.T_odom_body = fields.pose("robot pose");
  for (const char* const what : {"tv", "rv", "accel"}) fields.any_number(what);
  odometry.stamp = fields.stamp("ipc_timestamp");
  return odometry;
}

CarmenParameter parse_carmen_parameter(std::string_view contents) {
  LineTokenizer fields(contents);
  const std::string_view name = fields.word("parameter name");
  return {.name = name, .value = fields.is_empty() ? std::string_view{} : fields.word("parameter value")};
}

}  // namespace patrol::io
