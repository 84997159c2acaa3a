#pragma once

#include <optional>
#include <string_view>
#include <variant>
#include <vector>

#include "core/frames.h"
#include "core/time.h"

/// The lines of a CARMEN log (carmen.sourceforge.net, "Logging data"): "name contents ipc_timestamp ipc_hostname logger_timestamp".
namespace patrol::io {

/// A message of a lidar: FLASER and RLASER (the old ones: front and rear), RAWLASERn and ROBOTLASERn (the new ones; 1 front, 2 rear).
struct CarmenScan {
  Time stamp{};  ///< ipc_timestamp
  std::vector<double> ranges_m;         ///< [beam], as in the file
  std::vector<float> remissions;        ///< [beam], or empty
  /// Where the beams point, in the lidar; the old messages do not say (carmen_log.cc decides).
  std::optional<double> angle_min_rad, angle_increment_rad;
  std::optional<double> range_max_m;    ///< of the new messages, when it is above 0
  std::optional<Pose2> T_odom_lidar;    ///< RAWLASERn has neither
  std::optional<Pose2> T_odom_body;
};

struct CarmenOdometry {
  Time stamp{};
  Pose2 T_odom_body;
};

/// A setting of the robot, as "robot_frontlaser_offset 0.08".
struct CarmenParameter {
  std::string_view name;
  std::string_view value;
};

/// No line has more beams.
inline constexpr std::size_t kMostCarmenBeams = 10'000;

/// Whether this name is that of a lidar's message, by its family.
enum class CarmenLaserFamily { kOld, kRaw, kRobot };
std::optional<CarmenLaserFamily> carmen_laser_family(std::string_view name);
bool is_rear_laser(std::string_view name);

/// What follows the name of a message. Throw FieldError: the contents end too early, hold too much, or something that is no number.
CarmenScan parse_carmen_scan(CarmenLaserFamily family, std::string_view contents);
CarmenOdometry parse_carmen_odometry(std::string_view contents);
CarmenParameter parse_carmen_parameter(std::string_view contents);

}  // namespace patrol::io
