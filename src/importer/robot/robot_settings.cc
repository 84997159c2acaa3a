#include "importer/robot/robot_settings.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace patrol::importer {
namespace {

const char* kinematics_of(DriveType drive) {
  switch (drive) {
    case DriveType::kAckermann:
      return "ackermann";
    case DriveType::kMecanum:
      return "omnidirectional";
    default:
      return "differential";
  }
}

/// Rounds down to a multiple of `step`, within bounds.
double rounded_down(double value, double step, double min, double max) {
  return std::clamp(std::floor(value / step + 1e-9) * step, min, max);
}

/// Returns half of the lateral speed at which the wheels turn as fast as at the maximum forward speed.
double max_lateral_mps(const NormalizedRobot& robot, double max_speed_mps) {
  return rounded_down(0.5 * max_speed_mps * std::tan(robot.roller_angle_rad), 0.01, 0.05, 0.5);
}

std::string mecanum_settings(const NormalizedRobot& robot, double max_speed_mps) {
  std::string text = "wheel_drive:\n  type: mecanum\n";
  text += fmt::format("  roller_pattern: {}\n", robot.roller_pattern);
  text += fmt::format("  roller_angle_rad: {:.4f}\n", robot.roller_angle_rad);
  text += fmt::format("  max_speed_mps: {:.2f}\n", max_speed_mps);
  return text + fmt::format("  max_lateral_speed_mps: {:.2f}\n", max_lateral_mps(robot, max_speed_mps));
}

/// Returns the row of the stack's settings for a low lidar, or "".
std::string scan_settings(const NormalizedRobot& robot) {
  if (!robot.scan_band) return "";
  std::string row = fmt::format("  scan_leveling: {{min_height_m: {:.2f}", robot.scan_band->min_height_m);
  if (robot.scan_band->self_filter_radius_m < kDefaultSelfFilterRadius_m)
    row += fmt::format(", self_filter_radius_m: {:.2f}", robot.scan_band->self_filter_radius_m);
  return row + "}\n";
}

/// Returns the settings of a robot on wheels.
std::string wheel_settings(const NormalizedRobot& robot) {
  const bool is_ackermann = robot.drive == DriveType::kAckermann;
  const double max_speed_mps = rounded_down(robot.max_speed_mps, 0.01, 0.05, 1.5);
  const double planner_speed_mps = std::min(1.0, max_speed_mps);
  const double approach_m = rounded_down(0.8 * robot.length_m, 0.05, 0.3, is_ackermann ? 3.0 : 1.5);
  std::string text;
  text += "  joint_encoders: {rate_hz: 50.0, counts_per_revolution: 16384}\n";
  text += "  foot_contact: {enabled: false}\n";
  text += "  hall: {enabled: false}\n";
  text += robot.drive == DriveType::kMecanum ? mecanum_settings(robot, max_speed_mps)
                                             : fmt::format("wheel_drive: {{max_speed_mps: {:.2f}}}\n", max_speed_mps);
  text += "stack:\n";
  text += "  odometry_source: wheeled\n";
  text += "  odometry:\n";
  text += "    wheeled: {ticks_per_sprocket_turn: 16384}\n";
  text += scan_settings(robot);
  text += "  navigation:\n";
  text += fmt::format("    kinematics: {}\n", kinematics_of(robot.drive));
  text += "    footprint_rows: 2\n";
  text += fmt::format("    goal_approach_distance_m: {:.2f}\n", approach_m);
  text += "    approach_deceleration_mps2: 0.25\n";
  text += fmt::format("    recovery: {{behaviors: [{}], max_attempts: 6}}\n",
                      is_ackermann ? "wait, back_up" : "wait, back_up, spin");
  if (is_ackermann) text += fmt::format("    costmap: {{keep_out_margin_m: {:.2f}}}\n", robot.keep_out_margin_m);
  text += "    local_planner:\n";
  text += fmt::format("      dwa: {{max_speed_mps: {:.2f}, max_acceleration_mps2: 0.5{}}}\n", planner_speed_mps,
                      robot.drive == DriveType::kMecanum
                          ? fmt::format(", max_lateral_speed_mps: {:.2f}",
                                        rounded_down(0.5 * max_lateral_mps(robot, max_speed_mps), 0.01, 0.02, 0.25))
                          : "");
  return text;
}

/// Returns the settings of a robot with legs. Gait, gains and speeds are scaled when the robot is loaded.
std::string leg_settings(const NormalizedRobot& robot) {
  std::string text = "  hall: {enabled: false}\n";
  text += "stack:\n";
  text += "  odometry_source: legged\n";
  text += scan_settings(robot);
  text += "  navigation:\n";
  text += "    kinematics: omnidirectional\n";
  return text;
}

}  // namespace

std::string settings_of(const NormalizedRobot& robot, const std::string& comment) {
  std::string text = fmt::format("# {}\nsensors:\n", comment);
  // Absent sensors have no row: a mount that the user adds switches its sensor on.
  for (const char* frame : {"lidar", "lidar_rear", "lidar3d", "gnss", "depth_camera", "tdlas", "uwb"}) {
    if (std::ranges::find(robot.sensor_frames, frame) == robot.sensor_frames.end()) continue;
    const auto chosen = robot.lidars.find(frame);
    text +=
        fmt::format("  {}: {{enabled: true{}}}\n", frame, chosen == robot.lidars.end() ? "" : ", " + chosen->second);
  }
  return text + (robot.drive == DriveType::kLegs ? leg_settings(robot) : wheel_settings(robot));
}

}  // namespace patrol::importer
