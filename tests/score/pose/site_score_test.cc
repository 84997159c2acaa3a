#include "score/pose/site_score.h"

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "tests/support/pose_near.h"

namespace patrol::score::site_score_test {
namespace {

const Pose2 kStart{11.0, 8.0, to_rad(90.0)};

/// Forty meters along x and twenty along y in map, and its truth for a pose of the map.
struct Drive {
  Trajectory T_map_body, T_world_body;
};

Drive drive_with(const Pose2& T_world_map, double body_yaw_rad = 0.0) {
  Drive drive;
  for (int i = 0; i <= 60; ++i) {
    const Pose2 T_map_body{1.0 * std::min(i, 40), 1.0 * std::max(i - 40, 0), 0.0};
    drive.T_map_body.push_back({from_seconds(i), to_pose3(T_map_body)});
    drive.T_world_body.push_back({from_seconds(i), to_pose3(T_world_map * T_map_body * Pose2{0.0, 0.0, body_yaw_rad})});
  }
  return drive;
}

SiteRegistration registration_of(const Pose2& T_site_map, double at_s) {
  return {.stamp = from_seconds(at_s),
          .T_site_map = T_site_map,
          .covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal()};
}

TEST(SiteScore, WithoutRegistrationTheSurveyedStartCounts) {
  const Drive drive = drive_with(kStart * Pose2{0.0, 0.0, to_rad(0.5)});
  const SiteScore score = site_score(drive.T_map_body, kStart, drive.T_world_body);
  EXPECT_NEAR(score.yaw_error_deg, 0.5, 1e-6);
  EXPECT_NEAR(score.pose.ate_max_m, std::hypot(40.0, 20.0) * to_rad(0.5), 1e-3);
  EXPECT_FALSE(score.nees);
}

TEST(SiteScore, AnExactRegistrationHasNoError) {
  const Pose2 T_world_map = kStart * Pose2{0.02, 0.01, to_rad(0.5)};
  const Drive drive = drive_with(T_world_map);
  const SiteScore score =
      site_score(drive.T_map_body, {kStart, {registration_of(T_world_map, 0.0)}}, drive.T_world_body);
  EXPECT_NEAR(score.pose.ate_max_m, 0.0, 1e-9);
  EXPECT_NEAR(score.position_error_m, 0.0, 1e-9);
  EXPECT_NEAR(*score.nees, 0.0, 1e-9);
}

// Until the registration at 20 s the surveyed start holds, 2 cm off.
TEST(SiteScore, EachPoseTakesTheRegistrationOfItsTime) {
  const Pose2 T_world_map = kStart * Pose2{0.02, 0.0, 0.0};
  const Drive drive = drive_with(T_world_map);
  const SiteScore score =
      site_score(drive.T_map_body, {kStart, {registration_of(T_world_map, 20.0)}}, drive.T_world_body);
  EXPECT_NEAR(score.pose.ate_max_m, 0.02, 1e-9);
  EXPECT_NEAR(score.pose.ate_mean_m, 0.02 * 20.0 / 61.0, 1e-9);
}

TEST(SiteScore, NeesIsTheSquaredErrorInStandardDeviations) {
  const Drive drive = drive_with(kStart);
  const Pose2 wrong{kStart.x + 0.02, kStart.y, kStart.yaw + 3e-3};
  const SiteScore score = site_score(drive.T_map_body, {kStart, {registration_of(wrong, 0.0)}}, drive.T_world_body);
  EXPECT_NEAR(*score.nees, 4.0 + 9.0, 1e-6);
  EXPECT_NEAR(score.yaw_error_deg, to_deg(3e-3), 1e-6);
}

// The lidar is mounted with a yaw: the map is turned against the body, and its frame follows the path.
TEST(SiteScore, AConstantYawOfTheBodyIsNotOneOfTheMap) {
  const Drive drive = drive_with(kStart, to_rad(0.3));
  EXPECT_THAT(fit_map_frame(drive.T_map_body, drive.T_world_body), test::Pose2Near(kStart, 1e-9, 1e-9));
}

TEST(SiteScore, AStandingRobotIsAlignedAtItsStart) {
  const StampedPose pose{from_seconds(1.0), to_pose3(Pose2{})}, truth{from_seconds(1.0), to_pose3(kStart)};
  EXPECT_THAT(fit_map_frame({pose}, {truth}), test::Pose2Near(kStart, 1e-9, 1e-9));
}

}  // namespace
}  // namespace patrol::score::site_score_test
