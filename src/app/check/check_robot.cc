#include "app/check/check_robot.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "app/scenario/data_folders.h"
#include "app/scenario/mounts.h"
#include "app/scenario/scenario.h"
#include "app/scenario/sensor_needs.h"
#include "core/error.h"
#include "core/sensors/registry.h"
#include "core/skid_spread.h"
#include "core/wheel_kinematics.h"
#include "sim/locomotion/roller_contact.h"
#include "sim/sensors/sensor_suite_settings.h"

namespace patrol::app {
namespace {

constexpr double kMaxTurningRadius_m = 50.0;  // a circle takes minutes

DriveKind kind_of(const RobotDescription& robot) {
  if (robot.tracks) return DriveKind::kTracks;
  if (robot.wheels.empty()) return DriveKind::kLegs;
  switch (wheel_drive_type(robot)) {
    case WheelDriveType::kAckermann:
      return DriveKind::kAckermannWheels;
    case WheelDriveType::kMecanum:
      return DriveKind::kMecanumWheels;
    default:
      return DriveKind::kDifferentialWheels;
  }
}

DriveLimits limits_of_legs(const sim::LocomotionSettings& settings) {
  return {.max_speed_mps = settings.max_forward_mps,
          .max_yaw_rate_radps = settings.max_yaw_rate_radps,
          .max_acceleration_mps2 = settings.max_acceleration_mps2,
          .max_yaw_acceleration_radps2 = settings.max_yaw_acceleration_radps2};
}

double effective_gauge_ratio_of(const CheckRobot& robot) {
  if (robot.kind == DriveKind::kTracks) return robot.simulator.track_drive.effective_gauge_factor;
  if (robot.kind == DriveKind::kMecanumWheels) return skid_ratio(robot.description);
  if (robot.kind != DriveKind::kDifferentialWheels) return 0.0;
  const double factor = robot.simulator.wheel_drive.effective_gauge_factor;
  return factor > 0.0 ? factor : skid_ratio(robot.description);
}

/// Yaw rate of a differential drive whose sides move at the speeds -+`speed_mps`.
double yaw_rate_of_sides(double speed_mps, double gauge_m, double effective_gauge_ratio) {
  return 2.0 * speed_mps / (gauge_m * effective_gauge_ratio);
}

DriveLimits limits_of_tracks(const CheckRobot& robot) {
  const sim::TrackDriveSettings& settings = robot.simulator.track_drive;
  const double side_radps =
      yaw_rate_of_sides(settings.max_speed_mps, robot.description.tracks->gauge_m, robot.effective_gauge_ratio);
  return {.max_speed_mps = settings.max_speed_mps,
          .max_yaw_rate_radps = std::min(settings.max_yaw_rate_radps, side_radps),
          .max_acceleration_mps2 = settings.max_acceleration_mps2,
          .max_yaw_acceleration_radps2 = settings.max_yaw_acceleration_radps2};
}

DriveLimits limits_of_wheels(const CheckRobot& robot) {
  const sim::WheelDriveSettings& settings = robot.simulator.wheel_drive;
  double speed_mps = settings.max_speed_mps, lateral_mps = 0.0;
  if (robot.kind == DriveKind::kMecanumWheels) lateral_mps = settings.max_lateral_speed_mps;
  for (const WheelGeometry& wheel : robot.description.wheels) {
    if (!wheel.drive_joint) continue;
    const double no_load_radps = robot.description.joint_limits.at(*wheel.drive_joint).velocity_radps;
    speed_mps = std::min(speed_mps, wheel.radius_m * no_load_radps);
    if (wheel.roller_axis_rad)
      lateral_mps = std::min(lateral_mps, wheel.radius_m * no_load_radps / std::abs(std::tan(*wheel.roller_axis_rad)));
  }
  const double radius_m = min_turning_radius_m(robot.description);
  if (radius_m > kMaxTurningRadius_m) {
    throw InputError(
        fmt::format("robot {}: the steering joints reach only circles of {:.3g} m: patrol check needs at "
                    "most {:g} m, to both sides",
                    robot.name, radius_m, kMaxTurningRadius_m));
  }
  const double kinematic_radps =
      radius_m > 0.0
          ? speed_mps / radius_m
          : yaw_rate_of_sides(speed_mps, differential_geometry(robot.description).gauge_m, robot.effective_gauge_ratio);
  return {.max_speed_mps = speed_mps,
          .max_yaw_rate_radps = std::min(settings.max_yaw_rate_radps, kinematic_radps),
          .max_acceleration_mps2 = settings.max_acceleration_mps2,
          .max_yaw_acceleration_radps2 = settings.max_yaw_acceleration_radps2,
          .min_turning_radius_m = radius_m,
          .max_lateral_speed_mps = lateral_mps};
}

DriveLimits limits_of(const CheckRobot& robot) {
  switch (robot.kind) {
    case DriveKind::kLegs:
      return limits_of_legs(robot.simulator.locomotion);
    case DriveKind::kTracks:
      return limits_of_tracks(robot);
    default:
      return limits_of_wheels(robot);
  }
}

/// Returns the lidars that the settings enable and the robot has.
std::vector<CheckLidar> lidars_of(const sim::SensorSuiteSettings& sensors, const RobotDescription& robot) {
  std::vector<CheckLidar> lidars = {{"lidar", sensors.lidar, sim::kRayLidar2d},
                                    {"lidar_rear", sensors.lidar_rear, sim::kRayLidarRear},
                                    {"lidar3d", sensors.lidar3d, sim::kRayLidar3d}};
  std::erase_if(lidars, [&](const CheckLidar& lidar) {
    return !lidar.settings.enabled || !robot.T_body_sensor.contains(lidar.frame);
  });
  return lidars;
}

void disable_other_sensors(sim::SensorSuiteSettings& sensors) {
  Sensors::for_each([&]<typename Message>(std::type_identity<Message>) {
    if constexpr (HasSensorSettings<Message>) {
      auto& settings = sensors.*SensorTraits<Message>::kSettings;
      if constexpr (requires { settings.enabled; }) {
        if (!SensorTraits<Message>::kInfo.is_read_by_firmware) settings.enabled = false;
      }
    }
  });
}

}  // namespace

const char* name_of(DriveKind kind) {
  switch (kind) {
    case DriveKind::kLegs:
      return "legs";
    case DriveKind::kTracks:
      return "tracks";
    case DriveKind::kDifferentialWheels:
      return "differential wheels";
    case DriveKind::kMecanumWheels:
      return "mecanum wheels";
    default:
      return "Ackermann wheels";
  }
}

CheckRobot load_check_robot(const std::string& name, const std::vector<std::string>& overrides,
                            std::optional<std::uint64_t> seed, const std::filesystem::path& data_root) {
  find_robot(name, data_root);  // throws for an unknown robot
  std::vector<std::string> settings = overrides;
  settings.push_back("robot=" + name);
  const Scenario scenario = load_scenario({}, settings, data_root);
  LoadedRobot loaded = load_robot(name, data_root, scenario.mounts);
  std::vector<SensorNeed> needs = firmware_needs(loaded.description);
  needs.insert(needs.end(), scenario.requested.begin(), scenario.requested.end());
  require_sensors(needs, loaded.description, name, "patrol check");
  CheckRobot robot;
  robot.name = name;
  robot.seed = seed.value_or(scenario.seed);
  robot.overrides = overrides;
  robot.description = std::move(loaded.description);
  sim::set_drive_type(scenario.wheel_drive, robot.description);
  robot.simulator.robot_urdf = {loaded.urdf_file.string(), std::move(loaded.urdf)};
  robot.simulator.site.ground = {
      .all = {.geoms = {"ground*"}, .materials = {}, .groups = {}}, .curbs = {}, .max_step_m = 0.0};
  robot.simulator.as_built = scenario.as_built;
  robot.simulator.sensors = scenario.sensors;
  robot.simulator.locomotion = scenario.locomotion;
  robot.simulator.track_drive = scenario.track_drive;
  robot.simulator.wheel_drive = scenario.wheel_drive;
  robot.lidars = lidars_of(robot.simulator.sensors, robot.description);
  robot.scan_leveling = scenario.stack.scan_leveling;
  disable_other_sensors(robot.simulator.sensors);
  robot.kind = kind_of(robot.description);
  robot.effective_gauge_ratio = effective_gauge_ratio_of(robot);
  robot.limits = limits_of(robot);
  const bool has_legs = robot.kind == DriveKind::kLegs;
  const SkidTurn turn = has_legs ? SkidTurn{} : skid_turn(robot.description);
  robot.turn_center_x_m = turn.turn_center_x_m;
  const bool turns_by_sides = robot.kind == DriveKind::kDifferentialWheels || robot.kind == DriveKind::kMecanumWheels;
  if (turns_by_sides && scenario.as_built.enabled) {
    const double gauge_m = differential_geometry(robot.description).gauge_m * turn.gauge_ratio;
    const double drift_rad_per_m = 2.0 * scenario.as_built.wheels.radius_scale / gauge_m;
    robot.max_heading_drift_rad_per_m = std::max(robot.max_heading_drift_rad_per_m, drift_rad_per_m);
    for (const WheelGeometry& wheel : robot.description.wheels) {
      // Speed of the wheel relative to that of the robot to the side.
      const double ratio = wheel.roller_axis_rad ? std::abs(std::tan(*wheel.roller_axis_rad)) : 0.0;
      robot.max_sideways_drift_rad_per_m = std::max(robot.max_sideways_drift_rad_per_m, ratio * drift_rad_per_m);
    }
    // The radii are uniform within the tolerance.
    const double radius_std = scenario.as_built.wheels.radius_scale / std::numbers::sqrt3;
    robot.yaw_tolerance += 3.0 *
                           skid_ratio_std(robot.description, radius_std, scenario.wheel_drive.tire_deflection_ratio) /
                           turn.gauge_ratio;
  }
  if (has_legs) {
    if (scenario.as_built.enabled) robot.max_gyro_bias_radps = 3.0 * scenario.as_built.imu.gyro_bias_std_radps;
    robot.reaction_s = scenario.locomotion.gait_period_s;
  }
  robot.expected_height_m = has_legs ? scenario.locomotion.trunk_height_m : robot.description.body_height_m();
  return robot;
}

}  // namespace patrol::app
