#include "localize/dock_detector.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "tests/support/dock_world.h"
#include "tests/support/pose_near.h"

namespace patrol::localize::dock_detector_test {
namespace {

using test::make_dock_profile;
using test::make_dock_world;
using test::Pose2Near;
using test::RoomWorld;

constexpr double kStd_m = 0.025;

/// The room at the portal: walls 3 m to each side and 2 m behind the post.
RoomWorld make_portal(const Pose2& T_world_docked) {
  RoomWorld world = make_dock_world(T_world_docked, make_dock_profile());
  return world.add_wall(-20.0, -3.0, 3.0, -3.0).add_wall(-20.0, 3.0, 3.0, 3.0).add_wall(3.0, -3.0, 3.0, 3.0);
}

std::optional<DockDetection> look(const RoomWorld& world, const Pose2& T_world_body, const Pose2& T_level_expected,
                                  std::uint64_t tick = 0, double range_std_m = kStd_m,
                                  const std::vector<Eigen::Vector2d>& profile_m = make_dock_profile()) {
  const RandomStream noise(5, "test/lidar");
  const LevelScan scan = test::scan_from_mast(world, T_world_body, Time{}, range_std_m, noise, tick);
  return DockDetector({}, profile_m).detect(scan, T_level_expected);
}

TEST(DockDetector, WithoutNoiseFindsThePostToThreeMillimetersFromThirtyCentimetersOff) {
  const Pose2 T_world_body{-1.3, 0.05, 0.06};
  const Pose2 T_level_docked = T_world_body.inverse();
  for (const Pose2& off : {Pose2{0.0, 0.0, 0.0}, Pose2{0.25, -0.2, 0.15}, Pose2{-0.25, 0.25, -0.15}}) {
    const Pose2 expected{T_level_docked.x + off.x, T_level_docked.y + off.y, T_level_docked.yaw + off.yaw};
    const auto detection = look(make_portal({}), T_world_body, expected, 0, 0.0);
    ASSERT_TRUE(detection);
    EXPECT_THAT(detection->T_level_docked, Pose2Near(T_level_docked, 0.003, 0.004));
    EXPECT_GT(detection->inlier_ratio, 0.95);
  }
}

// 300 looks from between 1.4 m before the docked pose and there. Ratio of squared error to covariance: 3 on average if
// the covariance were exact (chi squared of three degrees of freedom, standard error of the mean sqrt(6 / 300) = 0.14);
// beams quantise the edges, so half and double are allowed.
TEST(DockDetector, ErrorsAreConsistentWithTheCovariance) {
  double squares = 0.0, worst_m = 0.0, worst_rad = 0.0;
  constexpr int kLooks = 300;
  for (std::uint64_t i = 0; i < kLooks; ++i) {
    const RandomStream stream(i, "test/place");
    const Pose2 T_world_body{-1.4 * stream.uniform(0), 0.1 * stream.uniform(1) - 0.05, 0.2 * stream.uniform(2) - 0.1};
    const Pose2 T_level_docked = T_world_body.inverse();
    const Pose2 expected{T_level_docked.x + 0.1, T_level_docked.y - 0.1, T_level_docked.yaw + 0.05};
    const auto detection = look(make_portal({}), T_world_body, expected, i);
    ASSERT_TRUE(detection) << i;
    const Eigen::Vector3d error(detection->T_level_docked.x - T_level_docked.x,
                                detection->T_level_docked.y - T_level_docked.y,
                                wrap_angle(detection->T_level_docked.yaw - T_level_docked.yaw));
    squares += error.dot(detection->covariance.inverse() * error);
    worst_m = std::max(worst_m, error.head<2>().norm());
    worst_rad = std::max(worst_rad, std::abs(error.z()));
  }
  EXPECT_GT(squares / kLooks, 1.5);
  EXPECT_LT(squares / kLooks, 6.0);
  EXPECT_LT(worst_m, 0.05);
  EXPECT_LT(worst_rad, 4.0 * kDegree);
}

// Of a box only the face is seen: its edges alone say where its middle is.
TEST(DockDetector, FindsTheMiddleOfAFlatFaceByItsEdges) {
  const std::vector<Eigen::Vector2d> box = {{0.9, -0.2}, {0.7, -0.2}, {0.7, 0.2}, {0.9, 0.2}};
  const Pose2 T_world_body{-1.0, 0.03, 0.02};
  const auto detection =
      look(make_dock_world({}, box), T_world_body, Pose2{0.05, 0.1, 0.02} * T_world_body.inverse(), 0, kStd_m, box);
  ASSERT_TRUE(detection);
  EXPECT_THAT(detection->T_level_docked, Pose2Near(T_world_body.inverse(), 0.02, 2.0 * kDegree));
}

// The notches look alike, 0.36 m apart: from the whole search it must not take one for the other. A single look errs by
// up to 5 cm and 4 degrees (ItsErrorsAreAsLargeAsItsCovarianceSays).
TEST(DockDetector, IsNotMistakenByOneNotchOfTwo) {
  const Pose2 T_world_body{-1.35, 0.02, 0.03};
  const Pose2 T_level_docked = T_world_body.inverse();
  for (std::uint64_t i = 0; i < 40; ++i) {
    const RandomStream stream(i, "test/expected");
    const Pose2 expected{T_level_docked.x + 0.5 * (stream.uniform(0) - 0.5),
                         T_level_docked.y + 0.6 * (stream.uniform(1) - 0.5),
                         T_level_docked.yaw + 0.3 * (stream.uniform(2) - 0.5)};
    const auto detection = look(make_dock_world({}, test::make_notched_dock_profile()), T_world_body, expected, i,
                                kStd_m, test::make_notched_dock_profile());
    ASSERT_TRUE(detection) << i;
    EXPECT_THAT(detection->T_level_docked, Pose2Near(T_level_docked, 0.05, 4.0 * kDegree)) << i;
  }
}

TEST(DockDetector, RefusesAFlatWallWhereThePostShouldBe) {
  const std::vector<Eigen::Vector2d> box = {{0.9, -0.2}, {0.7, -0.2}, {0.7, 0.2}, {0.9, 0.2}};
  RoomWorld wall;
  wall.add_wall(0.7, -3.0, 0.7, 3.0);
  for (std::uint64_t i = 0; i < 50; ++i) {
    EXPECT_FALSE(look(wall, {-1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, i, kStd_m, box)) << i;
    EXPECT_FALSE(look(wall, {-1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, i)) << i;
  }
}

TEST(DockDetector, RefusesOtherThings) {
  const Pose2 T_world_body{-1.2, 0.0, 0.0}, T_level_docked{1.2, 0.0, 0.0};
  EXPECT_FALSE(look(RoomWorld(), T_world_body, T_level_docked));
  for (std::uint64_t i = 0; i < 20; ++i) {
    RoomWorld legs, pallet;
    legs.add_post(0.75, 0.1, 0.07).add_post(0.75, -0.1, 0.07);
    pallet.add_box(0.7, -0.6, 1.5, 0.6);
    EXPECT_FALSE(look(legs, T_world_body, T_level_docked, i)) << i;
    EXPECT_FALSE(look(pallet, T_world_body, T_level_docked, i)) << i;
  }
}

TEST(DockDetector, RefusesAPostHalfHiddenByAPerson) {
  RoomWorld world = make_portal({});
  world.add_post(0.2, 0.12, 0.18);
  EXPECT_FALSE(look(world, {-1.2, 0.0, 0.0}, {1.2, 0.0, 0.0}));
}

// The same noise, with and without it: the post's own beams are the same, so must be the pose.
TEST(DockDetector, ACartNextToThePostDoesNotBiasThePose) {
  RoomWorld with_cart = make_portal({});
  with_cart.add_box(0.6, 0.45, 1.2, 1.0);
  const Pose2 expected{1.23, 0.04, 0.03};
  const auto without = look(make_portal({}), {-1.2, 0.0, 0.0}, expected, 3);
  const auto with = look(with_cart, {-1.2, 0.0, 0.0}, expected, 3);
  ASSERT_TRUE(with && without);
  EXPECT_THAT(with->T_level_docked, Pose2Near(without->T_level_docked, 0.001, 0.002));
}

TEST(DockDetector, NoDetectionFromTooFarAndInAnEmptyScan) {
  EXPECT_FALSE(look(make_portal({}), {-6.0, 0.0, 0.0}, {6.0, 0.0, 0.0}));
  EXPECT_FALSE(DockDetector({}, make_dock_profile()).detect({}, {1.0, 0.0, 0.0}));
}

TEST(DockDetector, RefusesAProfileOfOnePointAndSettingsThatBreakTheirRule) {
  EXPECT_THAT(
      [] {
        DockDetector({}, {{0.5, 0.0}});
      },
      ::testing::ThrowsMessage<InputError>(::testing::HasSubstr("dock profile: 1 points")));
  EXPECT_THAT([] { DockDetector({.min_inlier_ratio = 2.0}, make_dock_profile()); },
              ::testing::ThrowsMessage<InputError>(::testing::HasSubstr("docking.detector.min_inlier_ratio = 2")));
}

}  // namespace
}  // namespace patrol::localize::dock_detector_test
