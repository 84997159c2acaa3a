#include "app/check/maneuver_figures.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "app/check/measurements.h"
#include "core/geometry/angles.h"
#include "core/gravity.h"
#include "core/wheel_kinematics.h"

namespace patrol::app {
namespace {

// Limits, each with the reason that the page prints.
constexpr const char* kTiltOfPlane = "with this tilt, a planar lidar 0.5 m above the ground hits it at 5.7 m";
constexpr const char* kTiltOfObstacle = "half of the 60 degrees at which the firmware reports a fall";
constexpr const char* kTorqueMargin = "a tenth of the torque remains for obstacles and wear";
constexpr const char* kMeanTorque = "geared motors hold half of their peak torque without overheating";
constexpr const char* kSpeedMargin = "a tenth of the speed remains for the control";
constexpr const char* kTiltOfTrot = "twice the swing of the trunk when a trot begins and ends";
constexpr double kMaxPlaneTilt_deg = 5.0, kMaxTrotTilt_deg = 15.0, kMaxFallTilt_deg = 30.0;
constexpr double kYawTolerance = 0.15;  // of the yaw rate
constexpr double kMaxDrift_rad = 0.5;   // by gyro bias or radii; limits that allow more would reject nothing
constexpr double kMaxTorqueRatio = 0.9, kMaxMeanTorqueRatio = 0.5, kMaxSpeedRatio = 0.9, kMaxSwingSpeedRatio = 1.2;

Figure tilt_figure(const DriveRecord& record, double max_deg, const char* reason) {
  return {.name = "max_tilt_deg", .value = max_tilt_deg(record), .max = max_deg, .limit_reason = reason};
}

Figure& named(std::vector<Figure>& figures, const char* name) {
  return *std::ranges::find_if(figures, [&](const Figure& figure) { return figure.name == name; });
}

Figure plane_tilt_figure(const CheckRobot& robot, const DriveRecord& record) {
  const bool has_legs = robot.kind == DriveKind::kLegs;
  return tilt_figure(record, has_legs ? kMaxTrotTilt_deg : kMaxPlaneTilt_deg, has_legs ? kTiltOfTrot : kTiltOfPlane);
}

/// Adds torques and speeds of the motors relative to their limits.
void add_motor_figures(const DriveRecord& record, std::vector<Figure>& figures) {
  const MotorMargins margins = motor_margins(record);
  figures.push_back({.name = "max_torque_ratio",
                     .value = margins.max_torque_ratio,
                     .max = kMaxTorqueRatio,
                     .limit_reason = kTorqueMargin,
                     .is_key = true});
  figures.push_back({.name = "mean_torque_ratio", .value = margins.mean_torque_ratio});
  figures.push_back({.name = "max_motor_speed_ratio",
                     .value = margins.max_speed_ratio,
                     .max = kMaxSpeedRatio,
                     .limit_reason = kSpeedMargin});
}

/// Limits the mean torque in a maneuver that the robot can drive for minutes.
void limit_mean_torque(std::vector<Figure>& figures) {
  Figure& figure = named(figures, "mean_torque_ratio");
  figure.max = kMaxMeanTorqueRatio;
  figure.limit_reason = kMeanTorque;
}

void add_slip_figure(const CheckRobot& robot, const DriveRecord& record, double max, const char* reason,
                     std::vector<Figure>& figures) {
  if (robot.kind == DriveKind::kLegs) return;  // joint encoders of legs measure no travel
  figures.push_back(
      {.name = "slip_ratio", .value = slip_ratio(record), .max = max, .limit_reason = reason, .is_key = true});
}

/// Rotation by the bias of a gyro that the firmware follows, over the record, at most.
double gyro_drift_rad(const CheckRobot& robot, const DriveRecord& record) {
  return robot.max_gyro_bias_radps * record.samples.back().time_s;
}

/// Part of the yaw tolerance that the as-built radii of more than four wheels add.
double radius_tolerance(const CheckRobot& robot) { return std::max(0.0, robot.yaw_tolerance - kYawTolerance); }

/// Adds the gyro's bias and the as-built radii to the reason of a limit that includes them.
std::string with_tolerances(const CheckRobot& robot, std::string reason) {
  if (robot.max_gyro_bias_radps > 0.0) reason += ", and three standard deviations of the gyro's bias";
  if (radius_tolerance(robot) > 0.0)
    reason += fmt::format(", and {:.0f} % by the loads of more than four wheels with as-built radii",
                          100.0 * radius_tolerance(robot));
  return reason;
}

Figure symmetric(std::string name, double value, double max, std::string reason, bool is_key = false) {
  return {.name = std::move(name),
          .value = value,
          .min = -max,
          .max = max,
          .limit_reason = std::move(reason),
          .is_key = is_key};
}

/// True over commanded yaw.
Figure yaw_ratio_figure(const CheckRobot& robot, const DriveRecord& record) {
  const double tolerance =
      robot.yaw_tolerance + gyro_drift_rad(robot, record) / std::abs(record.samples.back().commanded_yaw_rad);
  return {.name = "yaw_rate_ratio",
          .value = yaw_ratio(record),
          .min = 1.0 - tolerance,
          .max = 1.0 + tolerance,
          .limit_reason = with_tolerances(robot, "navigation plans with the commanded yaw rate, ±15 %"),
          .is_key = true};
}

Figure reached_figure(const Maneuver& maneuver, const DriveRecord& record) {
  return {.name = "reached_m",
          .value = record.samples.back().T_start_center.x,
          .min = maneuver.world.end_x_m,
          .limit_reason = "end of the obstacle",
          .is_key = true};
}

}  // namespace

std::vector<Figure> measure_stand(const CheckRobot& robot, const Maneuver&, const DriveRecord& record) {
  double height_m = 0.0;
  for (const DriveSample& sample : record.samples)
    height_m += sample.T_world_body.position.z() / static_cast<double>(record.samples.size());
  // Feet and tires yield: legs by the control of the trunk, tires by their deflection.
  const double tolerance_m = std::max(0.02, 0.15 * robot.expected_height_m);
  return {{.name = "height_m",
           .value = height_m,
           .min = robot.expected_height_m - tolerance_m,
           .max = robot.expected_height_m + tolerance_m,
           .limit_reason = "height of the body origin by geometry or firmware, ±15 % and at least ±2 cm",
           .is_key = true},
          {.name = "max_tilt_deg",
           .value = max_tilt_deg(record),
           .max = kMaxPlaneTilt_deg,
           .limit_reason = kTiltOfPlane,
           .is_key = true},
          {.name = "drift_m",
           .value = max_center_distance_m(record),
           .max = 0.02,
           .limit_reason = "less than a cell of 5 cm of the map",
           .is_key = true}};
}

std::vector<Figure> measure_straight(const CheckRobot& robot, const Maneuver&, const DriveRecord& record) {
  const DriveSample& end = record.samples.back();
  const double drift_rad = gyro_drift_rad(robot, record), commanded_m = end.T_start_commanded.x;
  const double heading_drift_rad = robot.max_heading_drift_rad_per_m * commanded_m;
  std::vector<Figure> figures = {
      symmetric("distance_error_ratio", end.ground_travel_m / commanded_m - 1.0, 0.1,
                "navigation corrects a speed error of a tenth within its acceleration", true),
      symmetric("lateral_drift_m", end.T_start_center.y,
                (std::max(0.1, 0.5 * heading_drift_rad) + 0.5 * drift_rad) * commanded_m,
                with_tolerances(robot, "a tenth of the distance, or half of it times the limit of the heading")),
      symmetric("heading_drift_deg", to_deg(end.yaw_rad), to_deg(heading_drift_rad + drift_rad),
                with_tolerances(
                    robot, "1 degree per meter, or as-built radii of both sides at opposite ends of their tolerance"),
                true)};
  add_slip_figure(robot, record, 0.05, "rolling wheels and tracks slip by less than 1 %, and their radii vary by 1 %",
                  figures);
  add_motor_figures(record, figures);
  limit_mean_torque(figures);
  figures.push_back(plane_tilt_figure(robot, record));
  return figures;
}

std::vector<Figure> measure_sideways(const CheckRobot& robot, const Maneuver&, const DriveRecord& record) {
  const DriveSample& end = record.samples.back();
  const double commanded_m = end.T_start_commanded.y;
  const double heading_drift_rad = robot.max_sideways_drift_rad_per_m * std::abs(commanded_m);
  std::vector<Figure> figures = {
      {.name = "distance_m", .value = end.T_start_center.y, .is_key = true},
      {.name = "distance_ratio",
       .value = end.T_start_center.y / commanded_m,
       .min = 0.9,
       .max = 1.1,
       .limit_reason = "navigation plans with the commanded speed, ±10 %",
       .is_key = true},
      symmetric("forward_drift_m", end.T_start_center.x, std::max(0.1, 0.5 * heading_drift_rad) * std::abs(commanded_m),
                "a tenth of the distance, or half of it times the limit of the heading"),
      symmetric("heading_drift_deg", to_deg(end.yaw_rad), to_deg(heading_drift_rad),
                "1 degree per meter, or as-built radii of both axles at opposite ends of their tolerance", true)};
  add_motor_figures(record, figures);
  limit_mean_torque(figures);
  figures.push_back(plane_tilt_figure(robot, record));
  return figures;
}

std::vector<Figure> measure_loop(const CheckRobot& robot, const Maneuver& maneuver, const DriveRecord& record) {
  const DriveSample& end = record.samples.back();
  double length_m = 0.0;
  for (const DriveSegment& segment : maneuver.segments) length_m += segment.vx_mps * segment.duration_s;
  const double drift_rad = gyro_drift_rad(robot, record) + radius_tolerance(robot) * std::abs(end.commanded_yaw_rad);
  const Pose2 error = end.T_start_commanded.inverse() * end.T_start_center;
  std::vector<Figure> figures = {
      {.name = "closing_error_m",
       .value = error.position().norm(),
       .max = (0.2 + 0.25 * drift_rad) * length_m,
       .limit_reason = with_tolerances(robot, "a fifth of the path: yaw errors of 15 % at the corners of a square"),
       .is_key = true},
      symmetric("closing_yaw_deg", to_deg(end.yaw_rad - end.commanded_yaw_rad),
                to_deg(kYawTolerance * std::abs(end.commanded_yaw_rad) + drift_rad),
                with_tolerances(robot, "15 % of 360 degrees"), true),
      yaw_ratio_figure(robot, record)};
  if (drift_rad > kMaxDrift_rad) {
    for (Figure& figure : std::span(figures).first(2)) {
      figure.min = figure.max = std::nullopt;
      figure.limit_reason =
          fmt::format("no limit: {} may turn the robot by {:.0f} degrees",
                      robot.max_gyro_bias_radps > 0.0 ? "the gyro bias" : "as-built radii of more than four wheels",
                      to_deg(drift_rad));
    }
  }
  if (!robot.turns_in_place()) {
    const double radius_m = wide_circle_radius_m(robot);
    figures.push_back({.name = "radius_m",
                       .value = driven_circle(record, 0.1, 0.9).radius_m,
                       .min = 0.9 * radius_m,
                       .max = 1.1 * radius_m,
                       .limit_reason = "commanded radius ±10 %",
                       .is_key = true});
  }
  figures.push_back(plane_tilt_figure(robot, record));
  return figures;
}

std::vector<Figure> measure_turn(const CheckRobot& robot, const Maneuver&, const DriveRecord& record) {
  std::vector<Figure> figures = {yaw_ratio_figure(robot, record)};
  figures.push_back({.name = "center_drift_m",
                     .value = max_center_distance_m(record),
                     .max = 0.3,
                     .limit_reason = "free space that navigation keeps around a turning robot",
                     .is_key = true});
  if (robot.kind != DriveKind::kLegs) {
    figures.push_back({.name = "effective_gauge_ratio",
                       .value = effective_gauge_ratio(record, differential_geometry(robot.description).gauge_m),
                       .min = (1.0 - robot.yaw_tolerance) * robot.effective_gauge_ratio,
                       .max = (1.0 + robot.yaw_tolerance) * robot.effective_gauge_ratio,
                       .limit_reason = with_tolerances(robot, "gauge ratio in the kinematics of the firmware, ±15 %")});
  }
  add_motor_figures(record, figures);
  figures.push_back(plane_tilt_figure(robot, record));
  return figures;
}

std::vector<Figure> measure_circle(const CheckRobot& robot, const Maneuver&, const DriveRecord& record) {
  const double radius_m = robot.limits.min_turning_radius_m;
  std::vector<Figure> figures = {yaw_ratio_figure(robot, record)};
  figures.push_back(
      {.name = "center_drift_m",
       .value = (driven_circle(record, 0.1, 0.5).center_m - driven_circle(record, 0.5, 0.9).center_m).norm(),
       .max = 0.1 * radius_m,
       .limit_reason = "a tenth of the minimum turning radius",
       .is_key = true});
  figures.push_back({.name = "radius_m",
                     .value = driven_circle(record, 0.1, 0.9).radius_m,
                     .min = 0.9 * radius_m,
                     .max = 1.1 * radius_m,
                     .limit_reason = "minimum turning radius by the limits of the steering joints, ±10 %",
                     .is_key = true});
  add_motor_figures(record, figures);
  figures.push_back(plane_tilt_figure(robot, record));
  return figures;
}

std::vector<Figure> measure_ramp(const CheckRobot& robot, const Maneuver& maneuver, const DriveRecord& record) {
  std::vector<Figure> figures = {reached_figure(maneuver, record)};
  add_slip_figure(robot, record, 0.1, "odometry by wheels or tracks stays within a tenth on a slope", figures);
  add_motor_figures(record, figures);
  limit_mean_torque(figures);
  if (robot.kind == DriveKind::kLegs) {
    Figure& speed = named(figures, "max_motor_speed_ratio");
    speed.max = kMaxSwingSpeedRatio;
    speed.limit_reason = "feet that hit an edge in their swing turn the motors by up to a fifth faster";
  }
  figures.push_back({.name = "max_tilt_deg",
                     .value = max_tilt_deg(record),
                     .max = kRampAngle_deg + 10.0,
                     .limit_reason = "inclination of the ramp, and 10 degrees at its edges",
                     .is_key = true});
  figures.push_back({.name = "hull_contacts",
                     .value = static_cast<double>(record.num_hull_contacts),
                     .max = 0.0,
                     .limit_reason = "the hull does not scrape over the edges of the ramp"});
  return figures;
}

std::vector<Figure> measure_steps(const CheckRobot& robot, const Maneuver& maneuver, const DriveRecord& record) {
  std::vector<Figure> figures = {reached_figure(maneuver, record)};
  add_slip_figure(robot, record, 0.2, "wheels slip at the edges of the steps", figures);
  figures.push_back({.name = "max_torque_ratio", .value = motor_margins(record).max_torque_ratio});
  figures.push_back({.name = "max_tilt_deg",
                     .value = max_tilt_deg(record),
                     .max = kMaxFallTilt_deg,
                     .limit_reason = kTiltOfObstacle,
                     .is_key = true});
  figures.push_back({.name = "hull_contacts", .value = static_cast<double>(record.num_hull_contacts), .is_key = true});
  figures.push_back({.name = "hull_contact_s",
                     .value = record.hull_contact_s,
                     .max = 0.5,
                     .limit_reason = "a touch while landing is harmless, a robot that rests on its hull is stuck",
                     .is_key = true});
  return figures;
}

std::vector<Figure> measure_emergency_stop(const CheckRobot& robot, const Maneuver&, const DriveRecord& record) {
  const Stop stop = measure_stop(record, robot.kind == DriveKind::kLegs ? 0.05 : 0.02);
  const double v = stop.speed_mps, friction = std::max(record.friction, 1e-3);
  const double firmware_m = v * v / (2.0 * robot.limits.max_acceleration_mps2);
  const double friction_m = v * v / (2.0 * friction * kGravity_mps2);
  return {
      {.name = "speed_mps",
       .value = v,
       .min = 0.85 * robot.limits.max_speed_mps,
       .limit_reason = "the stop begins at the full speed, -15 %",
       .is_key = true},
      {.name = "stop_distance_m",
       .value = stop.distance_m,
       .min = 0.9 * friction_m,
       .max = 1.2 * std::max(firmware_m, friction_m) + robot.reaction_s * v,
       .limit_reason = "v² / (2 a) by the firmware's deceleration or friction, +20 % and the reaction time; at least "
                       "the friction limit, -10 %",
       .is_key = true},
      {.name = "stop_time_s", .value = stop.duration_s, .is_key = true},
      {.name = "firmware_limit_m", .value = firmware_m},
      {.name = "friction_limit_m", .value = friction_m},
      {.name = "friction", .value = friction},
      {.name = "at_rest", .value = stop.is_at_rest ? 1.0 : 0.0, .min = 1.0, .limit_reason = "the robot comes to rest"},
      tilt_figure(record, kMaxFallTilt_deg, kTiltOfObstacle)};
}

std::vector<Figure> measure_slope(const CheckRobot& robot, const Maneuver& maneuver, const DriveRecord& record) {
  const std::size_t begin = std::min(record.segment_ends.front(), record.samples.size()) - 1;
  const Eigen::Vector3d p_begin_m = record.samples[begin].T_world_body.position;
  double creep_m = 0.0;
  for (std::size_t i = begin; i < record.samples.size(); ++i)
    creep_m = std::max(creep_m, (record.samples[i].T_world_body.position - p_begin_m).norm());
  return {{.name = "reached_m",
           .value = record.samples[begin].T_start_center.x,
           .min = maneuver.world.begin_x_m + robot.description.outline_radius_m(),
           .limit_reason = "the whole robot is on the slope",
           .is_key = true},
          {.name = "creep_m",
           .value = creep_m,
           .max = 0.02,
           .limit_reason = "less than a cell of 5 cm of the map during a measurement",
           .is_key = true},
          {.name = "max_tilt_deg",
           .value = max_tilt_deg(record),
           .max = kRampAngle_deg + 10.0,
           .limit_reason = "inclination of the slope, and 10 degrees at its edge",
           .is_key = true}};
}

std::vector<std::string> failures_of(const CheckRobot& robot, const Maneuver& maneuver, const DriveRecord& record,
                                     const std::vector<Figure>& figures) {
  std::vector<std::string> failures;
  if (record.has_fallen) failures.push_back(fmt::format("falls over after {:.1f} s", record.samples.back().time_s));
  for (const Figure& figure : figures) {
    if (!figure.is_met())
      failures.push_back(fmt::format("{} {}: {}", label_of(figure), value_text(figure), limit_text(figure)));
  }
  const bool is_inclined = maneuver.name == "ramp" || maneuver.name == "slope_stand";
  const double needed = std::tan(to_rad(kRampAngle_deg));
  if (is_inclined && !failures.empty() && robot.kind != DriveKind::kLegs && record.friction < needed) {
    failures.insert(failures.begin(), fmt::format("friction {:.3f} is below tan {:g}° = {:.3f}", record.friction,
                                                  kRampAngle_deg, needed));
  }
  return failures;
}

}  // namespace patrol::app
