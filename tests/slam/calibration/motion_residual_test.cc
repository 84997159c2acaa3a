#include "slam/calibration/motion_residual.h"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "tests/slam/calibration/calibration_world.h"

namespace patrol::slam::motion_residual_test {
namespace {

const CalibrationVector kTruth{test::kWorn.lidar_x_m,      test::kWorn.lidar_y_m,
                               test::kWorn.lidar_yaw_rad,  test::kWorn.distance_scale,
                               test::kWorn.rotation_scale, test::kWorn.steering_bias_rad_per_m};

MotionSegment stretch() { return test::record(test::wandering(8), 8, test::kWorn, {}, 1).front(); }

TEST(MotionResidual, IsZeroForTheGroundTruth) { EXPECT_LT(motion_residual(stretch(), kTruth, {}).error.norm(), 1e-12); }

TEST(MotionResidual, ItsDerivativesAreThoseOfDifferences) {
  const MotionSegment pair = stretch();
  const CalibrationVector there = kTruth + CalibrationVector{0.1, 0.2, -0.1, 0.05, 0.1, -0.03};
  const MotionResidual residual = motion_residual(pair, there, {});
  constexpr double kStep = 1e-6;  // central: errors of kStep^2 and of 1e-16 / kStep
  for (Eigen::Index i = 0; i < 6; ++i) {
    const CalibrationVector offset = kStep * CalibrationVector::Unit(i);
    const Eigen::Vector3d slope =
        (motion_residual(pair, there + offset, {}).error - motion_residual(pair, there - offset, {}).error) /
        (2.0 * kStep);
    EXPECT_LT((residual.jacobian.col(i) - slope).norm(), 1e-8) << i;
  }
}

// A lidar that looks to the left has its own x along the body's y.
TEST(MotionResidual, TheLidarCovarianceIsRotatedIntoTheBody) {
  MotionSegment pair = stretch();
  pair.lidar_covariance = Eigen::Vector3d(4.0, 1.0, 0.25).asDiagonal();
  CalibrationVector left = kTruth;
  left[2] = 0.5 * std::numbers::pi;
  const MotionResidual residual = motion_residual(pair, left, {});
  EXPECT_LT((residual.lidar_covariance - Eigen::Matrix3d(Eigen::Vector3d(1.0, 4.0, 0.25).asDiagonal())).norm(), 1e-12);
  const Eigen::Matrix3d whole = residual.covariance(2.0, 3.0);
  EXPECT_NEAR(whole(2, 2), 0.25 + 9.0 * residual.odometry_covariance(2, 2), 1e-12);
  EXPECT_NEAR(whole(0, 0), 1.0 + 4.0 * residual.odometry_covariance(0, 0), 1e-12);
}

}  // namespace
}  // namespace patrol::slam::motion_residual_test
