#pragma once

#include <optional>
#include <string_view>
#include <variant>
#include <vector>

#include "core/frames.h"
#include "core/time.h"

/// Parser of CARMEN log lines (carmen.sourceforge.net, "Logging data"): "name contents ipc_timestamp ipc_hostname
/// logger_timestamp".
namespace patrol::io {

/// Lidar message. Old formats: FLASER (front) and RLASER (rear). New formats: RAWLASERn and ROBOTLASERn (1 front, 2
/// rear).
struct CarmenScan {
  Time stamp{};                   ///< ipc_timestamp
  std::vector<double> ranges_m;   ///< [beam], m, unmodified
  std::vector<float> remissions;  ///< [beam]; may be empty
  /// Beam angles in the lidar frame; not part of the old messages (see carmen_log.cc).
  std::optional<double> angle_min_rad, angle_increment_rad;
  std::optional<double> range_max_m;  ///< new messages only, if positive
  std::optional<Pose2> T_odom_lidar;  ///< neither pose is part of RAWLASERn
  std::optional<Pose2> T_odom_body;
};

struct CarmenOdometry {
  Time stamp{};
  Pose2 T_odom_body;
};

/// Robot parameter, such as "robot_frontlaser_offset 0.08".
struct CarmenParameter {
  std::string_view name;
  std::string_view value;
};

/// Maximum number of beams per message.
inline constexpr std::size_t kMaxCarmenBeams = 10'000;

/// Format of a lidar message.
enum class CarmenLaserFamily { kOld, kRaw, kRobot };
/// Returns the format of the lidar message with this name; nullopt for other messages.
std::optional<CarmenLaserFamily> carmen_laser_family(std::string_view name);
bool is_rear_laser(std::string_view name);

/// Parse the text after the message name. Throw ParseError if the text is too short, too long or not numeric.
CarmenScan parse_carmen_scan(CarmenLaserFamily family, std::string_view contents);
CarmenOdometry parse_carmen_odometry(std::string_view contents);
CarmenParameter parse_carmen_parameter(std::string_view contents);

}  // namespace patrol::io
