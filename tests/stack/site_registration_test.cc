#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "stack/make_stack.h"
#include "tests/stack/standing_quadruped.h"

namespace patrol::stack::site_registration_test {
namespace {

constexpr double kWalk_s = 34.0;
const SiteFrame kSite{.T_site_start = {11.0, 8.0, to_rad(90.0)},
                      .datum = GeodeticDatum{.latitude_deg = 29.21, .longitude_deg = 119.46}};
/// The robot stands 1 cm ahead of the surveyed start, 1 cm to its right, and turned by one degree.
const Pose2 kPutDown{0.01, -0.01, to_rad(1.0)};
const Pose2 kLevelGnss{-0.1, 0.05, 0.0};

/// A street of 40 m by 6 m with posts along it.
test::RoomWorld street() {
  test::RoomWorld world;
  world.add_box(-5.0, -3.0, 35.0, 3.0);
  for (int i = 0; i < 8; ++i) world.add_post(-2.0 + 4.7 * i, i % 2 == 0 ? 2.2 : -2.1, 0.2);
  return world;
}

GnssFix fix_at(const Eigen::Vector2d& p_site, Time stamp) {
  const GeodeticPosition position = to_geodetic(*kSite.datum, p_site);
  return {.stamp = stamp,
          .status = GnssStatus::kFix,
          .latitude_deg = position.latitude_deg,
          .longitude_deg = position.longitude_deg,
          .altitude_m = 0.0,
          .position_std_m = Eigen::Vector3d(0.01, 0.01, 0.02)};
}

struct WalkRecord {
  std::vector<SiteRegistration> registrations;
  Pose2 T_map_body;         ///< newest estimate
  Pose2 T_site_body_truth;  ///< truth at the end
};

/// Walks down the street at 0.6 m/s, whatever the stack commands, with exact fixes at 5 Hz.
WalkRecord walk(bool use_gnss) {
  RobotDescription robot = quadruped_with_outline();
  robot.T_body_sensor["gnss"] = to_pose3(kLevelGnss);
  StackSettings settings;
  settings.registration.use_gnss = use_gnss;
  Route route;
  route.stations = {{.number = 1, .name = "far", .type = StationType::kPass, .T_route_body = {30.0, 0.0, 0.0}}};
  Stack stack = make_stack(settings, robot, route, {.site = kSite, .seed = 1});

  test::WalkingRobotSettings quiet = test::WalkingRobotSettings::without_noise();
  quiet.roll_wobble_rad = quiet.pitch_wobble_rad = quiet.height_wobble_m = 0.0;
  test::WalkingRobot walker(robot, test::stand_then_walk(3.0, {.vx_mps = 0.6}), quiet, 1);
  const test::RoomWorld world = street();
  const Pose2 T_body_lidar = to_pose2(robot.T_body("lidar"));
  WalkRecord record;
  for (int tick = 0; to_seconds(walker.now()) < kWalk_s; ++tick) {
    walker.step();
    const Pose2 T_start_body = to_pose2(walker.T_world_body());
    record.T_site_body_truth = kSite.T_site_start * kPutDown * T_start_body;
    stack.handle(walker.imu(), walker.now());
    stack.handle(walker.joints(), walker.now());
    stack.handle(walker.contacts(), walker.now());
    if (tick % 25 == 0) stack.handle(scan_of(world, walker.now(), T_start_body * T_body_lidar), walker.now());
    if (tick % 50 == 0)
      stack.handle(fix_at(record.T_site_body_truth * kLevelGnss.position(), walker.now()), walker.now());
    stack.step(walker.now());
    for (const StackMessage& message : stack.take_messages()) {
      if (const auto* pose = std::get_if<PoseEstimate>(&message)) record.T_map_body = pose->T_map_body;
      if (const auto* found = std::get_if<SiteRegistration>(&message)) record.registrations.push_back(*found);
    }
  }
  return record;
}

double site_error_m(const WalkRecord& record) {
  const Pose2 T_site_body = record.registrations.back().T_site_map * record.T_map_body;
  return (T_site_body.position() - record.T_site_body_truth.position()).norm();
}

TEST(SiteRegistration, FixesFindThePutDownErrorThatTheStackDoesNotKnow) {
  const WalkRecord record = walk(true);
  ASSERT_GT(record.registrations.size(), 10U);
  const Pose2 T_site_map = kSite.T_site_start * kPutDown;
  EXPECT_LT(std::abs(wrap_angle(record.registrations.back().T_site_map.yaw - T_site_map.yaw)), to_rad(0.2));
  EXPECT_LT(record.registrations.back().covariance(2, 2), record.registrations.front().covariance(2, 2) / 4.0);
  EXPECT_LT(site_error_m(record), 0.08);
}

TEST(SiteRegistration, WithoutFixesItIsTheSurveyedStart) {
  const WalkRecord record = walk(false);
  ASSERT_EQ(record.registrations.size(), 1U);
  EXPECT_EQ(record.registrations[0].T_site_map.vector(), kSite.T_site_start.vector());
  EXPECT_GT(site_error_m(record), 0.2);  // 18 m by one degree
}

}  // namespace
}  // namespace patrol::stack::site_registration_test
