#include "render/snapshot_builder.h"

#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/render/small_scene.h"
#include "tests/support/pose_near.h"

namespace patrol::render::run_follower_test {
namespace {

using namespace std::chrono_literals;
using test::VectorNear;

GroundTruth truth_at(Time stamp, double x, double y, double yaw) {
  return {.stamp = stamp, .T_world_body = {{x, y, 0.3}, quaternion_from_yaw(yaw)}, .twist = {}};
}

PoseEstimate estimate_at(Time stamp, const Pose2& T_map_body) {
  return {.stamp = stamp, .T_map_body = T_map_body, .covariance = Eigen::Matrix3d::Zero()};
}

/// One beam straight ahead and one to the left, 50 ms later.
LaserScan two_beams(Time stamp, float ahead_m, float left_m) {
  LaserScan scan;
  scan.stamp = stamp;
  scan.angle_increment_rad = std::numbers::pi / 2.0;
  scan.time_increment_s = 0.05;
  scan.ranges_m = {ahead_m, left_m};
  return scan;
}

class RunFollowerTest : public ::testing::Test {
 protected:
  sim::ModelPtr model = small_scene(kRobotBeforeWall);
  const Pose2 T_world_map{10.0, 20.0, std::numbers::pi / 2.0};  // map's x is north
  SnapshotBuilder follower{*model, T_world_map};
};

TEST_F(RunFollowerTest, ThereIsNoErrorBeforeTheFirstEstimate) {
  follower.add(truth_at(0s, 10.0, 20.0, 1.6));
  EXPECT_FALSE(follower.snapshot().T_map_body);
  EXPECT_FALSE(follower.snapshot().T_true_estimate);
}

TEST_F(RunFollowerTest, ErrorsAreThoseOfTheEstimatesOwnInstant) {
  follower.add(truth_at(0s, 10.0, 20.0, 1.6));
  follower.add(truth_at(1s, 10.0, 21.0, 1.6));
  follower.add(truth_at(2s, 10.0, 25.0, 1.6));
  // At 1 s the truth was 1 m north; the estimate says 1.03 m north, 0.04 m west (map's y), and 0.1 rad less
  // heading.
  follower.add(estimate_at(1s, {1.03, 0.04, 1.5 - std::numbers::pi / 2.0}));
  EXPECT_NEAR(follower.snapshot().T_true_estimate.value().position().norm(), 0.05, 1e-9);
  EXPECT_NEAR(follower.snapshot().T_true_estimate.value().yaw, -0.1, 1e-9);
}

// The wall's face is at x = 4 m; the finding is on it, 1 m above the body.
TEST_F(RunFollowerTest, AFindingIsOutlinedOnTheSurfaceWithARadiusOf40Centimeters) {
  SnapshotBuilder at_origin(*model, {});
  at_origin.add(truth_at(0s, 0.0, 0.0, 0.0));
  LiningResult result;
  result.findings = {{.ring = 29, .inward_m = 0.0042, .level = WarningLevel::kAlarm, .p_map = {4.0, 0.0, 1.0}}};
  at_origin.add(result);
  ASSERT_EQ(at_origin.snapshot().lining_marks.size(), 1u);
  const LiningMark& mark = at_origin.snapshot().lining_marks[0];
  EXPECT_EQ(mark.text, "ring 29: +4.2 mm");
  EXPECT_TRUE(mark.is_alarm);
  EXPECT_THAT(mark.p_world_m, VectorNear(Eigen::Vector3d(4.0, 0.0, 1.3), 1e-9));
  ASSERT_EQ(mark.outline.size(), 33u);
  for (const Eigen::Vector3d& p_m : mark.outline) {
    EXPECT_NEAR(p_m.x(), 4.0, 0.03);
    EXPECT_NEAR((p_m - mark.p_world_m).norm(), 0.4, 0.05);
  }
}

TEST_F(RunFollowerTest, AddsUpTheWayWalked) {
  for (int i = 0; i <= 100; ++i) follower.add(truth_at(i * 10ms, 0.03 * i, 0.04 * i, 0.0));
  EXPECT_NEAR(follower.snapshot().traveled_m, 5.0, 1e-9);
}

TEST_F(RunFollowerTest, PathsLieOnTheGround) {
  for (int i = 0; i <= 10; ++i) {
    follower.add(truth_at(i * 100ms, 0.1 * i, 0.0, 0.0));
    follower.add(estimate_at(i * 100ms, {0.1 * i, 0.0, 0.0}));
  }
  follower.add(Path{.stamp = 1s, .T_map_body = {{0.0, 0.0, 0.0}, {2.0, 0.0, 0.0}}});
  const RunSnapshot& seen = follower.snapshot();
  EXPECT_EQ(seen.true_path.size(), 11u);
  EXPECT_THAT(seen.true_path.back(), VectorNear(Eigen::Vector3d(1.0, 0.0, 0.01), 1e-4));
  EXPECT_THAT(seen.estimated_path.back(), VectorNear(Eigen::Vector3d(10.0, 21.0, 0.01), 1e-4));
  EXPECT_THAT(seen.planned_path.back(), VectorNear(Eigen::Vector3d(10.0, 22.0, 0.01), 1e-4));
}

TEST_F(RunFollowerTest, BeamsEndWhereTheRobotBelievedThemTo) {
  follower.add(truth_at(0s, 10.0, 20.0, std::numbers::pi / 2.0));
  follower.add(two_beams(0s, 2.0f, 3.0f));
  follower.add(estimate_at(0s, {1.0, 0.0, 0.0}));  // a metre north of the start
  ASSERT_EQ(follower.snapshot().scan.size(), 2u);
  EXPECT_THAT(follower.snapshot().scan[0], VectorNear(Eigen::Vector3d(10.0, 23.0, 0.4), 1e-6));
  EXPECT_THAT(follower.snapshot().scan[1], VectorNear(Eigen::Vector3d(7.0, 21.0, 0.4), 1e-6));
}

TEST_F(RunFollowerTest, BeamsAreFreedOfTheRobotsTurningAndLeaning) {
  follower.add(truth_at(0s, 10.0, 20.0, std::numbers::pi / 2.0));
  // Turning left at 1 rad/s, rolled by 0.1 rad all the while.
  for (int i = -10; i <= 20; ++i) {
    OdometryEstimate odometry;
    odometry.stamp = i * 10ms;
    odometry.T_odom_body = {{0.0, 0.0, 0.3}, quaternion_from_rpy(0.1, 0.0, 0.01 * i)};
    follower.add(odometry);
  }
  follower.add(two_beams(0s, 2.0f, 3.0f));
  follower.add(estimate_at(0s, {0.0, 0.0, 0.0}));
  // The lidar sits 0.1 m up the body's leaning z axis; the second beam is fired 50 ms later, turned by 0.05
  // rad.
  const Eigen::Quaterniond lean_ahead = quaternion_from_rpy(0.1, 0.0, std::numbers::pi / 2.0);
  const Eigen::Quaterniond lean_left = quaternion_from_rpy(0.1, 0.0, std::numbers::pi / 2.0 + 0.05);
  const Eigen::Vector3d body(10.0, 20.0, 0.3);
  ASSERT_EQ(follower.snapshot().scan.size(), 2u);
  EXPECT_THAT(follower.snapshot().scan[0], VectorNear(body + lean_ahead * Eigen::Vector3d(2.0, 0.0, 0.1), 1e-6));
  EXPECT_THAT(follower.snapshot().scan[1], VectorNear(body + lean_left * Eigen::Vector3d(0.0, 3.0, 0.1), 1e-6));
}

TEST_F(RunFollowerTest, TellsTheNewestEventAndWhetherItIsAnAlarm) {
  Event event;
  event.kind = EventKind::kGasAlarm;
  event.text = "Leak at regulator_box_2.";
  follower.add(event);
  EXPECT_EQ(follower.snapshot().event, "Leak at regulator_box_2.");
  EXPECT_TRUE(follower.snapshot().is_alarm);
  event.kind = EventKind::kStationReached;
  follower.add(event);
  EXPECT_FALSE(follower.snapshot().is_alarm);
}

TEST_F(RunFollowerTest, BeamsWithoutAReturnAreNotDrawn) {
  follower.add(truth_at(0s, 10.0, 20.0, 0.0));
  follower.add(two_beams(0s, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()));
  follower.add(estimate_at(0s, {}));
  EXPECT_TRUE(follower.snapshot().scan.empty());
}

TEST(RunFollowerAmong, ActorsDrawsPathsOnTheGroundAndNotOnThem) {
  const auto model = small_scene(std::string(kRobotBeforeWall) +
                                 R"(<body pos="1 0 0.1" mocap="true"><geom type="box" size="0.3 0.3 0.1"/></body>)");
  SnapshotBuilder follower(*model, {});
  follower.add(truth_at(0s, 1.0, 0.0, 0.0));
  EXPECT_THAT(follower.snapshot().true_path.back(), VectorNear(Eigen::Vector3d(1.0, 0.0, 0.01), 1e-4));
  EXPECT_EQ(follower.free_distance_m({0.0, 0.0, 0.1}, Eigen::Vector3d::UnitX(), 2.0), 2.0);
  EXPECT_NEAR(follower.free_distance_m({0.0, 0.0, 0.6}, Eigen::Vector3d::UnitX(), 10.0), 4.0, 1e-4);
}

TEST(RunFollowerBefore, ABridgeDrawsThePlanOnItsDeckAndNotUnderIt) {
  const auto model =
      small_scene(std::string(kRobotBeforeWall) + R"(<geom type="box" size="0.5 1 0.05" pos="2 0 0.45"/>)");
  SnapshotBuilder follower(*model, {});
  follower.add(truth_at(0s, 0.0, 0.0, 0.0));
  follower.add(Path{.stamp = 0s, .T_map_body = {{0.0, 0.0, 0.0}, {2.0, 0.0, 0.0}}});
  EXPECT_THAT(follower.snapshot().planned_path.back(), VectorNear(Eigen::Vector3d(2.0, 0.0, 0.51), 1e-4));
}

TEST(RunFollowerOf, ARobotThatWalksHasNoCameraAndDoesNotDrive) {
  const auto model = small_scene(kRobotBeforeWall);
  const SnapshotBuilder follower(*model, {});
  EXPECT_FALSE(follower.head_m());
  EXPECT_FALSE(follower.snapshot().is_driving);
}

TEST(RunFollowerOf, ATrackedRobotDrivesAndLooksOutOfItsDepthCamera) {
  const auto model = small_scene(R"(
    <body name="base_link" pos="0 0 0.2"><freejoint/><geom type="box" size="0.5 0.3 0.1"/>
      <site name="lidar" pos="0 0 0.4"/><site name="depth_camera" pos="0.4 0 0.2" euler="0 20 0"/>
      <body name="left_sprocket" pos="0 0.3 0"><joint axis="0 1 0"/><geom size="0.1"/></body>
    </body>)");
  const SnapshotBuilder follower(*model, {});
  EXPECT_TRUE(follower.snapshot().is_driving);
  EXPECT_THAT(follower.head_m().value(), VectorNear(Eigen::Vector3d(0.4, 0.0, 0.2), 1e-9));
}

TEST(RunFollowerWithout, ALidarHasTheErrorsOfTheEstimateAsWithOne) {
  const auto model = small_scene(R"(<body name="base_link"><geom size="0.1"/></body>)");
  SnapshotBuilder follower(*model, {});
  follower.add(truth_at(0s, 1.0, 2.0, 0.0));
  follower.add(truth_at(1s, 1.0, 2.0, 0.0));
  follower.add(estimate_at(1s, {1.03, 2.04, 0.1}));
  EXPECT_NEAR(follower.snapshot().T_true_estimate.value().position().norm(), 0.05, 1e-9);
}

}  // namespace
}  // namespace patrol::render::run_follower_test
