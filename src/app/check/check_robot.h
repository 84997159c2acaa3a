#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/angles.h"
#include "core/robot_description.h"
#include "core/sensors/lidar.h"
#include "localize/scan_leveler_settings.h"
#include "sim/lidar_scene.h"
#include "sim/simulator/simulator.h"

namespace patrol::app {

/// Drive of a robot, which decides on the maneuvers of its check.
enum class DriveKind { kLegs, kTracks, kDifferentialWheels, kAckermannWheels, kMecanumWheels };

/// "legs", "tracks", "differential wheels", "Ackermann wheels" or "mecanum wheels".
const char* name_of(DriveKind kind);

/// Speeds and accelerations that the firmware of a robot accepts.
struct DriveLimits {
  double max_speed_mps = 0.0;          ///< forward; on wheels at most the no-load speed of the slowest motor
  double max_yaw_rate_radps = 0.0;     ///< maximum yaw rate, at the maximum speed of the outer wheels or track
  double max_acceleration_mps2 = 0.0;  ///< maximum change of the commanded velocity per second, also when stopping
  double max_yaw_acceleration_radps2 = 0.0;  ///< maximum change of the commanded yaw rate per second
  double min_turning_radius_m = 0.0;         ///< 0: the robot turns in place
  double max_lateral_speed_mps = 0.0;  ///< maximum lateral speed of mecanum wheels; 0: the check has no lateral motion
};

/// Lidar of a robot.
struct CheckLidar {
  std::string frame;
  LidarSettings settings;
  sim::RayMask housing;  ///< shapes that its own beams ignore
};

/// Robot of a check drive.
struct CheckRobot {
  std::string name;
  std::uint64_t seed = 1;
  std::vector<std::string> overrides;  ///< "path=value"
  RobotDescription description;
  DriveKind kind = DriveKind::kLegs;
  DriveLimits limits;
  double turn_center_x_m = 0.0;  ///< longitudinal position in body of the point that the velocity commands refer to
  /// Gauge in the firmware's kinematics relative to the geometric one; 0 for legs and Ackermann wheels.
  double effective_gauge_ratio = 0.0;
  double expected_height_m = 0.0;  ///< height of the body origin above level ground by geometry or firmware
  /// Bound of the yaw rate error of a firmware that follows its gyro without an estimate of the bias: three standard
  /// deviations of the as-built bias. Only robots with legs do so.
  double max_gyro_bias_radps = 0.0;
  /// Bound of the heading error per distance: 1 degree per meter, or more if the wheels of both sides of a differential
  /// or mecanum drive have as-built radii at opposite ends of their tolerance.
  double max_heading_drift_rad_per_m = kDegree;
  /// Bound of the heading error per distance to the side: 1 degree per meter, or more if the wheels of both axles of a
  /// mecanum drive have as-built radii at opposite ends of their tolerance.
  double max_sideways_drift_rad_per_m = kDegree;
  /// Bound of the error of the yaw rate relative to the commanded one: 15 %. For a rigid chassis on more than four
  /// wheels, three standard deviations of the gauge ratio by the as-built radii are added.
  double yaw_tolerance = 0.15;
  double reaction_s = 0.1;         ///< time in which the firmware follows a command: with legs a period of the gait
  std::vector<CheckLidar> lidars;  ///< lidars that the settings enable
  localize::ScanLevelerSettings scan_leveling = {};  ///< settings of the built-in stack
  sim::SimulatorSettings simulator;                  ///< settings of the simulator without world and start pose

  bool turns_in_place() const { return limits.min_turning_radius_m == 0.0; }
};

/// Loads a robot of `models` with its profile and "path=value" overrides of scenario settings, as a run without a
/// scenario file. Sensors that the firmware does not read are switched off. Without `seed`, the seed is that of the
/// settings. Throws InputError for an unknown robot and for invalid overrides.
CheckRobot load_check_robot(const std::string& name, const std::vector<std::string>& overrides,
                            std::optional<std::uint64_t> seed, const std::filesystem::path& data_root);

}  // namespace patrol::app
