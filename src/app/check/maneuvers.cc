#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "app/check/maneuver.h"
#include "app/check/maneuver_figures.h"

namespace patrol::app {
namespace {

constexpr double kNominalRatio = 0.6;       // nominal speed and yaw rate relative to the maximum
constexpr double kAccelerationRatio = 0.5;  // acceleration of nominal driving relative to the maximum
constexpr double kStraight_m = 10.0, kSideways_m = 5.0, kSquare_m = 3.0;
constexpr double kStand_s = 3.0, kSlopeStand_s = 5.0;
constexpr double kFreeAhead_m = 1.0;    // level ground between robot and obstacle
constexpr double kRest_s = 1.5;         // time at rest after a segment: drives decelerate and close their brakes
constexpr double kMaxDelayRatio = 2.0;  // time limit of an obstacle relative to its nominal time

double nominal_mps(const CheckRobot& robot) { return kNominalRatio * robot.limits.max_speed_mps; }

/// Segment with the time of its rise by the accelerations of nominal driving.
DriveSegment nominal_segment(const CheckRobot& robot, double vx_mps, double yaw_rate_radps, double duration_s) {
  const double ramp_s = std::max(std::abs(vx_mps) / robot.limits.max_acceleration_mps2,
                                 std::abs(yaw_rate_radps) / robot.limits.max_yaw_acceleration_radps2) /
                        kAccelerationRatio;
  return {.vx_mps = vx_mps,
          .yaw_rate_radps = yaw_rate_radps,
          .duration_s = duration_s,
          .ramp_s = ramp_s,
          .rest_s = kRest_s};
}

DriveSegment straight_segment(const CheckRobot& robot, double distance_m) {
  return nominal_segment(robot, nominal_mps(robot), 0.0, distance_m / nominal_mps(robot));
}

DriveSegment turn_segment(const CheckRobot& robot, double angle_rad) {
  const double rate_radps = kNominalRatio * robot.limits.max_yaw_rate_radps;
  return nominal_segment(robot, 0.0, rate_radps, angle_rad / rate_radps);
}

/// Full circle to the left.
DriveSegment circle_segment(const CheckRobot& robot, double radius_m) {
  const double speed_mps =
      kNominalRatio * std::min(robot.limits.max_speed_mps, robot.limits.max_yaw_rate_radps * radius_m);
  return nominal_segment(robot, speed_mps, speed_mps / radius_m, 2.0 * std::numbers::pi * radius_m / speed_mps);
}

double duration_of(const Maneuver& maneuver) {
  double sum_s = maneuver.settle_s;
  for (const DriveSegment& segment : maneuver.segments) sum_s += segment.duration_s + segment.ramp_s + segment.rest_s;
  return sum_s;
}

Maneuver obstacle(const CheckRobot& robot, std::string name, std::string title, CheckWorld world) {
  const double goal_m = world.end_x_m + robot.description.outline_radius_m() + 0.2;
  DriveSegment segment = straight_segment(robot, kMaxDelayRatio * goal_m);
  segment.goal_ahead_m = goal_m;
  return {.name = std::move(name), .title = std::move(title), .world = std::move(world), .segments = {segment}};
}

/// Drive from the plane to a place where the whole robot is on the slope.
DriveSegment slope_segment(const CheckRobot& robot, double begin_x_m) {
  const double goal_m = begin_x_m + robot.description.outline_radius_m() + 0.5;
  DriveSegment segment = straight_segment(robot, kMaxDelayRatio * goal_m);
  segment.goal_ahead_m = goal_m;
  segment.rest_s = 2.0 * kRest_s;
  return segment;
}

Maneuver loop(const CheckRobot& robot) {
  if (!robot.turns_in_place()) {
    const double radius_m = wide_circle_radius_m(robot);
    return {.name = "circle",
            .title = fmt::format("Circle of {:.2f} m, 1.2 times the minimum radius", radius_m),
            .world = plane_world(),
            .segments = {circle_segment(robot, radius_m)},
            .measure = measure_loop};
  }
  Maneuver square{.name = "square",
                  .title = fmt::format("Square of {:g} m", kSquare_m),
                  .world = plane_world(),
                  .segments = {},
                  .measure = measure_loop};
  for (int side = 0; side < 4; ++side) {
    square.segments.push_back(straight_segment(robot, kSquare_m));
    square.segments.push_back(turn_segment(robot, 0.5 * std::numbers::pi));
  }
  return square;
}

Maneuver turn(const CheckRobot& robot) {
  if (robot.turns_in_place())
    return {.name = "turn",
            .title = "Turn in place by 360°",
            .world = plane_world(),
            .segments = {turn_segment(robot, 2.0 * std::numbers::pi)},
            .measure = measure_turn};
  return {.name = "turn",
          .title = fmt::format("Full circle of the minimum radius {:.2f} m", robot.limits.min_turning_radius_m),
          .world = plane_world(),
          .segments = {circle_segment(robot, robot.limits.min_turning_radius_m)},
          .measure = measure_circle};
}

Maneuver sideways(const CheckRobot& robot) {
  const double speed_mps = kNominalRatio * robot.limits.max_lateral_speed_mps;
  DriveSegment segment = nominal_segment(robot, speed_mps, 0.0, kSideways_m / speed_mps);
  segment.vy_mps = std::exchange(segment.vx_mps, 0.0);
  return {.name = "sideways",
          .title = fmt::format("{:g} m sideways at {:.2f} m/s", kSideways_m, speed_mps),
          .world = plane_world(),
          .segments = {segment},
          .measure = measure_sideways};
}

Maneuver emergency_stop(const CheckRobot& robot) {
  const double v = robot.limits.max_speed_mps, ramp_s = v / (kAccelerationRatio * robot.limits.max_acceleration_mps2);
  constexpr double kFullSpeed_s = 2.0, kStop_s = 4.0;
  return {.name = "emergency_stop",
          .title = fmt::format("Emergency stop from {:.2f} m/s", v),
          .world = plane_world(),
          .segments = {{.vx_mps = v,
                        .duration_s = ramp_s + kFullSpeed_s,
                        .ramp_s = ramp_s,
                        .is_stopped_abruptly = true,
                        .rest_s = kStop_s + v / robot.limits.max_acceleration_mps2}},
          .measure = measure_emergency_stop};
}

}  // namespace

std::vector<Maneuver> maneuvers_of(const CheckRobot& robot) {
  const double obstacle_x_m = robot.description.outline_radius_m() + kFreeAhead_m;
  Maneuver stand{.name = "stand",
                 .title = "Stand for 3 s",
                 .world = plane_world(),
                 .segments = {{.rest_s = kStand_s}},
                 .picture_ahead_m = 0.0,
                 .measure = measure_stand};
  Maneuver straight{.name = "straight",
                    .title = fmt::format("{:g} m straight at {:.2f} m/s", kStraight_m, nominal_mps(robot)),
                    .world = plane_world(),
                    .segments = {straight_segment(robot, kStraight_m)},
                    .measure = measure_straight};
  Maneuver ramp =
      obstacle(robot, "ramp", fmt::format("Ramp of {:g}°, up and down", kRampAngle_deg), ramp_world(obstacle_x_m));
  ramp.picture_ahead_m = obstacle_x_m + 0.6 * kRampLength_m;
  ramp.measure = measure_ramp;
  Maneuver steps =
      obstacle(robot, "steps", fmt::format("{} steps of {:g} cm up and down", kNumSteps, 100.0 * kStepHeight_m),
               steps_world(obstacle_x_m));
  steps.picture_ahead_m = obstacle_x_m + 0.5 * kStepSpacing_m;
  steps.measure = measure_steps;
  Maneuver slope{.name = "slope_stand",
                 .title = fmt::format("Rest on a slope of {:g}° for {:g} s", kRampAngle_deg, kSlopeStand_s),
                 .world = slope_world(obstacle_x_m),
                 .segments = {slope_segment(robot, obstacle_x_m), {.rest_s = kSlopeStand_s}},
                 .measure = measure_slope};
  std::vector<Maneuver> maneuvers = {std::move(stand), std::move(straight), loop(robot),           turn(robot),
                                     std::move(ramp),  std::move(steps),    emergency_stop(robot), std::move(slope)};
  if (robot.limits.max_lateral_speed_mps > 0.0) maneuvers.insert(maneuvers.begin() + 2, sideways(robot));
  for (Maneuver& maneuver : maneuvers) maneuver.duration_s = duration_of(maneuver);
  return maneuvers;
}

}  // namespace patrol::app
