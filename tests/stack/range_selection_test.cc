#include <cmath>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "core/random.h"
#include "stack/make_stack.h"
#include "tests/stack/standing_quadruped.h"

namespace patrol::stack::range_selection_test {
namespace {

constexpr double kWalk_s = 25.0, kNoise_m = 0.05, kDelay_m = 0.1;
const Pose3 kAntenna{{0.1, 0.0, 0.2}, Eigen::Quaterniond::Identity()};

/// A street of 30 m by 6 m with posts along it.
test::RoomWorld street() {
  test::RoomWorld world;
  world.add_box(-5.0, -3.0, 25.0, 3.0);
  for (int i = 0; i < 6; ++i) world.add_post(-2.0 + 4.7 * i, i % 2 == 0 ? 2.2 : -2.1, 0.2);
  return world;
}

/// Estimated range delays, by the name of the parameter, after a walk past two anchors: both ranges have a delay of
/// 10 cm, and those to the second one have an excess of 15 cm and 30 cm more on average.
std::map<std::string, CalibrationValue> delays_after_walk() {
  RobotDescription robot = quadruped_with_outline();
  robot.T_body_sensor["uwb"] = kAntenna;
  StackSettings settings;
  Route route;
  route.anchors = {{.number = 1, .p_m = {4.0, 2.8, 2.0}}, {.number = 2, .p_m = {9.0, -2.8, 2.0}}};
  route.stations = {{.number = 1, .name = "far", .type = StationType::kPass, .T_route_body = {20.0, 0.0, 0.0}}};
  Stack stack = make_stack(settings, robot, route, {.seed = 1});

  test::WalkingRobotSettings quiet = test::WalkingRobotSettings::without_noise();
  quiet.roll_wobble_rad = quiet.pitch_wobble_rad = quiet.height_wobble_m = 0.0;
  test::WalkingRobot walker(robot, test::stand_then_walk(3.0, {.vx_mps = 0.6}), quiet, 1);
  const test::RoomWorld world = street();
  const Pose2 T_body_lidar = to_pose2(robot.T_body("lidar"));
  const RandomStream noise(1, "range_selection_test/noise"), excess(1, "range_selection_test/excess");
  std::map<std::string, CalibrationValue> delays;
  for (int tick = 0; to_seconds(walker.now()) < kWalk_s; ++tick) {
    walker.step();
    const Pose2 T_start_body = to_pose2(walker.T_world_body());
    stack.handle(walker.imu(), walker.now());
    stack.handle(walker.joints(), walker.now());
    stack.handle(walker.contacts(), walker.now());
    if (tick % 25 == 0) stack.handle(scan_of(world, walker.now(), T_start_body * T_body_lidar), walker.now());
    if (tick % 50 == 0) {
      for (const UwbAnchor& anchor : route.anchors) {
        const auto index = static_cast<std::uint64_t>(anchor.number);
        const Eigen::Vector3d p_antenna = walker.T_world_body() * kAntenna.position;
        const double distance_m = (anchor.p_m - p_antenna).norm();
        const double excess_m = anchor.number == 2 ? 0.15 - 0.3 * std::log(excess.uniform(tick)) : 0.0;
        stack.handle(UwbRange{.stamp = walker.now(),
                              .anchor = anchor.number,
                              .range_m = distance_m + uwb_bias_at({}, distance_m).bias_m + kDelay_m + excess_m +
                                         kNoise_m * noise.normal(tick, index)},
                     walker.now());
      }
    }
    stack.step(walker.now());
    for (const StackMessage& message : stack.take_messages()) {
      if (const auto* calibration = std::get_if<CalibrationEstimate>(&message))
        for (const CalibrationValue& value : calibration->values) delays[value.name] = value;
    }
  }
  return delays;
}

TEST(RangeSelection, CalibrationTakesRangesInLineOfSightOnly) {
  const auto delays = delays_after_walk();
  ASSERT_TRUE(delays.contains(anchor_delay_name(1)));
  EXPECT_NEAR(delays.at(anchor_delay_name(1)).value, kDelay_m, 0.1);
  const auto hidden = delays.find(anchor_delay_name(2));
  if (hidden == delays.end()) return;  // no range was used
  EXPECT_LT(std::abs(hidden->second.value - kDelay_m), 2.0 * hidden->second.std) << hidden->second.value;
}

TEST(PoseCalibration, ContainsTheBiasesOfTheOdometrySource) {
  const auto values = delays_after_walk();
  for (const char* name : {"imu.gyro_x_bias_radps", "imu.gyro_y_bias_radps", "imu.accel_x_bias_mps2",
                           "imu.accel_y_bias_mps2", "imu.accel_z_bias_mps2"}) {
    ASSERT_TRUE(values.contains(name)) << name;
    EXPECT_GT(values.at(name).std, 0.0) << name;
  }
  EXPECT_FALSE(values.contains("odometry.turn_center_x_m")) << "a robot without tracks";
}

}  // namespace
}  // namespace patrol::stack::range_selection_test
