#include "io/logs/carmen_log.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "io/files/line_tokenizer.h"

namespace patrol::io {
namespace {

constexpr double kMaxMount_m = 2.0;  ///< maximum distance of the lidar from the robot origin
constexpr double kSameMount_m = 0.05, kSameMountRad = 0.05;
constexpr double kEqualPoses = 1e-6;  ///< m, rad: last digit written by CARMEN
constexpr double kMaxStepDeg = 5.0;
constexpr int kLinesToChooseFrom = 1000;

/// Lidar messages by decreasing information: own angles and pose, pose, angles; front before rear.
constexpr std::array<std::string_view, 6> kLasers = {"ROBOTLASER1", "FLASER", "RAWLASER1",
                                                     "ROBOTLASER2", "RLASER", "RAWLASER2"};

/// Known instruments that the old messages do not describe, by number of beams: Hokuyo URG-04LX (1024 steps per turn)
/// and UTM-30LX.
struct KnownStep {
  std::size_t num_beams;
  double step_deg;
};
constexpr double kUrgStepDeg = 360.0 / 1024.0;
constexpr std::array<KnownStep, 7> kKnownSteps = {
    {{682, kUrgStepDeg}, {683, kUrgStepDeg}, {769, kUrgStepDeg}, {540, 0.5}, {541, 0.5}, {1080, 0.25}, {1081, 0.25}}};

/// Returns whether a word is a message name, the first word of a log line: "FLASER", "NMEAGGA", "WIFI-SCAN".
bool is_message_name(std::string_view word) {
  constexpr std::size_t kMaxNameLength = 40;
  const auto is_letter = [](char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_'; };
  const auto belongs = [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '-'; };
  return word.size() <= kMaxNameLength && is_letter(word.front()) && std::all_of(word.begin(), word.end(), belongs);
}

std::string choose_laser(const std::filesystem::path& file) {
  LineReader lines(file);
  std::size_t best = kLasers.size();
  for (auto line = lines.next(); line && !line->is_cut && line->number <= kLinesToChooseFrom; line = lines.next()) {
    const std::string_view name = line->text.substr(0, line->text.find(' '));
    best = std::min(best, static_cast<std::size_t>(std::find(kLasers.begin(), kLasers.end(), name) - kLasers.begin()));
  }
  return best < kLasers.size() ? std::string(kLasers[best]) : "";
}

/// Converts a range to the conventions of REP 117: NaN invalid, +Inf no return.
float to_range(double range_m, double no_return_m) {
  if (std::isnan(range_m) || range_m <= 0.0) return std::numeric_limits<float>::quiet_NaN();
  return range_m >= no_return_m ? std::numeric_limits<float>::infinity() : static_cast<float>(range_m);
}

bool are_equal(const Pose2& a, const Pose2& b, double tolerance_m, double tolerance_rad) {
  return (a.position() - b.position()).norm() <= tolerance_m && std::abs(wrap_angle(a.yaw - b.yaw)) <= tolerance_rad;
}

}  // namespace

CarmenLog::CarmenLog(const std::filesystem::path& file, const ScanLogOptions& options)
    : options_(options),
      lines_(file),
      laser_(options.carmen_laser.empty() ? choose_laser(file) : options.carmen_laser) {}

std::string CarmenLog::location() const { return fmt::format("{}:{}: ", lines_.file().string(), line_); }

std::optional<RecordedScan> CarmenLog::next() {
  while (true) {
    if (std::optional<RecordedScan> scan = sorter_.take(is_at_end_)) {
      count_returned(*scan);
      return scan;
    }
    if (is_at_end_) return std::nullopt;
    if (!read_line()) finish();
  }
}

bool CarmenLog::read_line() {
  const std::optional<LineReader::Line> line = lines_.next();
  if (!line) return false;
  line_ = line->number;
  count_read();
  try {
    read_message(*line);
  } catch (const ParseError& error) {
    if (lines_.read_error()) {  // the last line is incomplete; finish() reports why
      --line_;
      return true;
    }
    reject_or_skip(options_, "unreadable lines", location() + error.what());
  }
  return true;
}

void CarmenLog::finish() {
  is_at_end_ = true;
  if (lines_.read_error())
    reject_or_skip(options_, "unexpected end of file",
                   fmt::format("{}: {} after line {}", lines_.file().string(), *lines_.read_error(), line_));
  if (is_rear_laser(laser_) && (summary().num_scans > 0 || !sorter_.is_empty()))
    add_found(fmt::format("{} is the rear laser of CARMEN: it looks backward (log.carmen_laser)", laser_));
  if (summary().num_scans == 0 && sorter_.is_empty()) {
    const std::string missing =
        laser_.starts_with("RAWLASER") && !odometry_
            ? fmt::format("contains {} without odometry ({}): must contain ODOM", laser_, counted(summary()))
            : fmt::format("contains no scan ({}): must contain FLASER, ROBOTLASER1 or RAWLASER1", counted(summary()));
    throw InputError(fmt::format("{}: {}", lines_.file().string(), missing));
  }
}

void CarmenLog::read_message(const LineReader::Line& line) {
  if (line.is_cut) throw ParseError(fmt::format("line longer than {} bytes", LineReader::kMaxLineBytes));
  LineTokenizer words(line.text);
  if (words.is_empty() || line.text.front() == '#') return;
  const std::string_view name = words.word("message name");
  if (!is_message_name(name)) throw ParseError("must begin with a message name such as FLASER or ODOM");
  const std::string_view contents =
      line.text.substr(static_cast<std::size_t>(name.data() - line.text.data()) + name.size());
  const std::optional<CarmenLaserFamily> family = carmen_laser_family(name);
  if (family && laser_.empty()) laser_ = name;
  try {
    if (family && name == laser_) return add(parse_carmen_scan(*family, contents));
    if (name == "PARAM") return store_parameter(parse_carmen_parameter(contents));
    if (name == "ODOM") {
      odometry_ = parse_carmen_odometry(contents);
      if (laser_.starts_with("RAWLASER")) return;
    }
    count_ignored(std::string(name));
  } catch (const ParseError& error) {
    throw ParseError(fmt::format("{}: {}", name, error.what()));
  }
}

void CarmenLog::store_parameter(const CarmenParameter& parameter) {
  for (const std::string_view side : {"front", "rear"}) {
    for (const std::string& name :
         {fmt::format("robot_{}laser_offset", side), fmt::format("robot_{}laser_side_offset", side),
          fmt::format("robot_{}laser_angular_offset", side), fmt::format("laser_{}_laser_resolution", side)}) {
      if (parameter.name == name) parameters_[name] = LineTokenizer(parameter.value).number(name.c_str());
    }
  }
}

double CarmenLog::parameter(const std::string& name, double otherwise) const {
  const auto found = parameters_.find(name);
  return found == parameters_.end() ? otherwise : found->second;
}

void CarmenLog::add(CarmenScan scan) {
  if (!scan.T_odom_body) {
    if (!odometry_)
      return count_skipped("scans before the first ODOM", location() + laser_ + ": no pose and no preceding ODOM");
    scan.T_odom_body = odometry_->T_odom_body;
  }
  const Pose2 T_odom_body = *scan.T_odom_body, T_body_lidar = mount_of(scan);
  sort_in(sorter_, {.scan = to_laser_scan(std::move(scan)), .T_odom_body = T_odom_body, .T_body_lidar = T_body_lidar},
          options_, location() + laser_);
}

/// Returns the mount of the lidar from the parameters. The rear lidar of CARMEN points backward, and its offset is
/// measured backward (carmen robot_laser).
Pose2 CarmenLog::parameter_mount() const {
  const bool is_rear = is_rear_laser(laser_);
  const std::string prefix = is_rear ? "robot_rearlaser" : "robot_frontlaser";
  const Pose2 T_body_facing{0.0, 0.0, is_rear ? std::numbers::pi : 0.0};
  return T_body_facing * Pose2{parameter(prefix + "_offset", 0.0), parameter(prefix + "_side_offset", 0.0),
                               parameter(prefix + "_angular_offset", 0.0)};
}

Pose2 CarmenLog::mount_of(const CarmenScan& scan) {
  if (!scan.T_odom_lidar) return parameter_mount();
  const Pose2 T_body_lidar = scan.T_odom_body->inverse() * *scan.T_odom_lidar;
  const bool is_uninformative = are_equal(T_body_lidar, {}, kEqualPoses, kEqualPoses);
  if (!T_body_lidar_)
    T_body_lidar_ = is_uninformative || T_body_lidar.position().norm() > kMaxMount_m ? parameter_mount() : T_body_lidar;
  const bool is_elsewhere = !is_uninformative && !are_equal(T_body_lidar, *T_body_lidar_, kSameMount_m, kSameMountRad);
  if (is_elsewhere) count_assumed("scans: lidar pose of the first scan");
  return *T_body_lidar_;
}

double CarmenLog::old_step_deg(std::size_t num_beams, std::size_t num_steps) const {
  const auto* const known = std::find_if(kKnownSteps.begin(), kKnownSteps.end(),
                                         [&](const KnownStep& step) { return step.num_beams == num_beams; });
  const double usual_deg =
      known == kKnownSteps.end() ? 180.0 / static_cast<double>(std::max<std::size_t>(1, num_steps)) : known->step_deg;
  const double parameter_deg =
      parameter(is_rear_laser(laser_) ? "laser_rear_laser_resolution" : "laser_front_laser_resolution", usual_deg);
  const bool is_possible =
      parameter_deg > 0.0 && parameter_deg <= kMaxStepDeg && parameter_deg * static_cast<double>(num_steps) <= 360.0;
  return is_possible ? parameter_deg : usual_deg;
}

LaserScan CarmenLog::to_laser_scan(CarmenScan scan) const {
  const std::size_t num_beams = scan.ranges_m.size();
  const std::size_t num_steps = num_beams % 2 == 0 ? num_beams : num_beams - 1;
  LaserScan to;
  to.stamp = scan.stamp;
  to.angle_increment_rad =
      scan.angle_increment_rad ? *scan.angle_increment_rad : kDegree * old_step_deg(num_beams, num_steps);
  to.angle_min_rad =
      scan.angle_min_rad ? *scan.angle_min_rad : -0.5 * to.angle_increment_rad * static_cast<double>(num_steps);
  to.range_max_m = std::min(options_.no_return_m, scan.range_max_m.value_or(options_.no_return_m));
  to.ranges_m.reserve(num_beams);
  for (const double range_m : scan.ranges_m) to.ranges_m.push_back(to_range(range_m, to.range_max_m));
  to.intensities = std::move(scan.remissions);
  return to;
}

}  // namespace patrol::io
