#include "plan/control/dock_pose_filter.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/random.h"
#include "tests/support/pose_near.h"

namespace patrol::plan::dock_track_test {
namespace {

using test::Pose2Near;

DockDetection see(double time_s, const Pose2& T_level_docked, double std_m = 0.01, double std_rad = 0.01) {
  const Eigen::Vector3d stds(std_m, std_m, std_rad);
  return {.stamp = from_seconds(time_s), .T_level_docked = T_level_docked, .covariance = stds.cwiseAbs2().asDiagonal()};
}

TEST(DockPoseFilter, TheFirstLookIsBelieved) {
  DockPoseFilter track({});
  EXPECT_FALSE(track.T_odom_docked());
  const Pose2 T_odom_body{3.0, 1.0, 2.0}, T_level_docked{1.2, 0.1, 0.05};
  track.add(see(1.0, T_level_docked), T_odom_body);
  EXPECT_THAT(*track.T_odom_docked(), Pose2Near(T_odom_body * T_level_docked, 1e-12, 1e-12));
}

// From a standstill, without a floor to a look's spread: standard deviation 1 cm / sqrt(100).
TEST(DockPoseFilter, AHundredLooksFromOnePlaceAreTenTimesAsGoodAsOne) {
  DockPoseFilter track({.yaw_random_walk_rad_per_sqrt_s = 0.0, .min_std_m = 1e-4, .min_std_rad = 1e-4});
  const RandomStream noise(7, "test/looks");
  for (std::uint64_t i = 0; i < 100; ++i) {
    const Pose2 seen{1.0 + 0.01 * noise.normal(i, 0), 0.01 * noise.normal(i, 1), 0.01 * noise.normal(i, 2)};
    track.add(see(0.1 * static_cast<double>(i), seen), {});
  }
  EXPECT_NEAR(std::sqrt(track.covariance()(0, 0)), 0.001, 1e-4);
  EXPECT_THAT(*track.T_odom_docked(), Pose2Near(Pose2{1.0, 0.0, 0.0}, 0.004, 0.004));
}

// 1 m driven adds (3 cm)^2 along; a turn by 1 rad adds 0.05 rad, which at 1 m moves the dock aside by 5 cm, and 3 cm of
// skid.
TEST(DockPoseFilter, OdometryThatHasMovedIsTrustedLess) {
  DockPoseFilterSettings settings;
  settings.yaw_random_walk_rad_per_sqrt_s = 0.0;
  DockPoseFilter moved(settings), turned(settings);
  const double least_var = 1e-4 + settings.min_std_m * settings.min_std_m;
  moved.add(see(0.0, {2.0, 0.0, 0.0}), {});
  moved.add(see(0.1, {9.0, 0.0, 0.0}), {1.0, 0.0, 0.0});  // an outlier: only the drift remains
  EXPECT_NEAR(moved.covariance()(0, 0), least_var + 0.03 * 0.03, 1e-12);
  turned.add(see(0.0, {0.0, 1.0, 0.0}), {});
  turned.add(see(0.1, {9.0, 0.0, 0.0}), {0.0, 0.0, 1.0});
  EXPECT_NEAR(turned.covariance()(2, 2), least_var + 0.05 * 0.05, 1e-12);
  const double place_var = turned.covariance()(0, 0) + turned.covariance()(1, 1);
  EXPECT_NEAR(place_var, 2.0 * least_var + 0.05 * 0.05 + 0.03 * 0.03, 1e-12);
}

// Ten seconds at rest add (0.003 rad)^2 each.
TEST(DockPoseFilter, HeadingIsTrustedLessWithTimeEvenAtRest) {
  const DockPoseFilterSettings settings;
  DockPoseFilter track(settings);
  track.add(see(0.0, {2.0, 0.0, 0.0}), {});
  const double before = track.covariance()(2, 2);
  track.add(see(10.0, {9.0, 0.0, 0.0}), {});  // an outlier: only the drift remains
  EXPECT_NEAR(track.covariance()(2, 2) - before, 10.0 * 0.003 * 0.003, 1e-12);
}

TEST(DockPoseFilter, AnOutlierIsPassedOverAndSixInARowAreBelieved) {
  DockPoseFilter track({});
  for (int i = 0; i < 20; ++i) track.add(see(0.1 * i, {1.0, 0.0, 0.0}), {});
  track.add(see(2.1, {1.0, 0.3, 0.0}), {});
  EXPECT_THAT(*track.T_odom_docked(), Pose2Near(Pose2{1.0, 0.0, 0.0}, 1e-9, 1e-9));
  for (int i = 0; i < 5; ++i) track.add(see(2.2 + 0.1 * i, {1.0, 0.3, 0.0}), {});
  EXPECT_THAT(*track.T_odom_docked(), Pose2Near(Pose2{1.0, 0.3, 0.0}, 1e-9, 1e-9));
}

TEST(DockPoseFilter, ALookOlderThanTheLastChangesNothing) {
  DockPoseFilter track({});
  track.add(see(1.0, {1.0, 0.0, 0.0}), {});
  track.add(see(0.5, {1.02, 0.0, 0.0}), {});
  EXPECT_EQ(track.num_detections(), 1);
  track.reset();
  EXPECT_FALSE(track.T_odom_docked());
}

}  // namespace
}  // namespace patrol::plan::dock_track_test
