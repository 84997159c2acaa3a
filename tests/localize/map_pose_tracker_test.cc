#include "localize/map_pose_tracker.h"

#include <numbers>

#include <gtest/gtest.h>

namespace patrol::localize::map_pose_tracker_test {
namespace {

constexpr double kExactTol = 1e-12;
constexpr double kQuarter = std::numbers::pi / 2.0;
const Eigen::Matrix3d kCovariance = Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal();

TEST(MapPoseTracker, BeforeAnyCorrectionMapIsOdom) {
  const PoseEstimate pose = MapPoseTracker().at(from_seconds(1.0), {1.0, 2.0, 0.5});
  EXPECT_EQ(pose.T_map_body.vector(), Eigen::Vector3d(1.0, 2.0, 0.5));
  EXPECT_EQ(pose.stamp, from_seconds(1.0));
}

TEST(MapPoseTracker, CarriesACorrectionOnByOdometry) {
  MapPoseTracker tracker;
  // Odometry had the body at (1, 0), heading 0; SLAM says (5, 5), heading 90 degrees. One meter on, ahead is
  // map's y.
  tracker.correct(from_seconds(1.0), {1.0, 0.0, 0.0}, {5.0, 5.0, kQuarter}, kCovariance);
  const Pose2 pose = tracker.at(from_seconds(2.0), {2.0, 0.0, 0.0}).T_map_body;
  EXPECT_NEAR(pose.x, 5.0, kExactTol);
  EXPECT_NEAR(pose.y, 6.0, kExactTol);
  EXPECT_NEAR(pose.yaw, kQuarter, kExactTol);
}

TEST(MapPoseTracker, HeadingErrorRotatesTheDistanceTraveled) {
  MapPoseTracker tracker({.position_std_m_per_m = 0.0, .yaw_std_rad_per_m = 0.0, .yaw_std_rad_per_rad = 0.0});
  tracker.correct(Time{0}, {}, {}, kCovariance);
  // 10 m along x with 1 mrad of heading: 1 cm across, (1e-3 * 10)^2 = 1e-4 more than before.
  const Eigen::Matrix3d covariance = tracker.at(from_seconds(10.0), {10.0, 0.0, 0.0}).covariance;
  EXPECT_NEAR(covariance(0, 0), 1e-4, kExactTol);
  EXPECT_NEAR(covariance(1, 1), 2e-4, kExactTol);
}

TEST(MapPoseTracker, UncertaintyGrowsWithDistanceAndRotation) {
  MapPoseTracker tracker;
  tracker.correct(Time{0}, {}, {}, Eigen::Matrix3d::Zero());
  const Eigen::Matrix3d covariance = tracker.at(from_seconds(1.0), {1.0, 0.0, 1.0}).covariance;
  EXPECT_NEAR(covariance(0, 0), 0.02 * 0.02, kExactTol);
  EXPECT_NEAR(covariance(2, 2), 0.015 * 0.015, kExactTol);
}

TEST(MapPoseTracker, CorrectionFromThePastIsIgnored) {
  MapPoseTracker tracker;
  tracker.correct(from_seconds(2.0), {}, {1.0, 0.0, 0.0}, kCovariance);
  tracker.correct(from_seconds(1.0), {}, {9.0, 0.0, 0.0}, kCovariance);
  EXPECT_NEAR(tracker.at(from_seconds(3.0), {}).T_map_body.x, 1.0, kExactTol);
}

}  // namespace
}  // namespace patrol::localize::map_pose_tracker_test
