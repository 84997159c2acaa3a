#include "slam/calibration/calibrate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/slam/calibration/calibration_world.h"

namespace patrol::slam::calibrate_test {
namespace {

using test::kWorn, test::record, test::wandering;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr test::Noise kNoise{.odometry_m = 0.002, .odometry_rad = 0.002, .lidar_m = 0.001, .lidar_rad = 0.0005};
enum Parameter : std::size_t { kX, kY, kYaw, kDistance, kTurn, kSteering };

Vector6 vector_of(const Calibration& c) {
  return {c.lidar_x_m, c.lidar_y_m, c.lidar_yaw_rad, c.distance_scale, c.rotation_scale, c.steering_bias_rad_per_m};
}

/// Errors in standard deviations.
Vector6 normalized_errors(const CalibrationResult& result, const Calibration& truth) {
  Vector6 errors = vector_of(result.calibration()) - vector_of(truth);
  for (std::size_t i = 0; i < 6; ++i) errors[static_cast<Eigen::Index>(i)] /= result.parameters[i].std;
  return errors;
}

std::vector<Pose2> repeated(const Pose2& step, std::size_t count) { return std::vector<Pose2>(count, step); }

std::vector<std::string> not_observable(const CalibrationResult& result) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < 6; ++i) {
    if (!result.parameters[i].is_observable) names.emplace_back(kCalibrationParameters[i]);
  }
  return names;
}

TEST(Calibrate, WithoutNoiseAllSixAreFoundExactly) {
  const CalibrationResult result = calibrate(record(wandering(600), 6, kWorn, {}, 1), {}, {});
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.num_rejected, 0);
  EXPECT_LT((vector_of(result.calibration()) - vector_of(kWorn)).norm(), 1e-6);
  EXPECT_TRUE(result.calibration().override_lidar_pose);
}

// 20 seeds of 6 errors, each of variance 1: the mean square of 120 has a standard deviation of sqrt(2/120) = 0.13 where
// they are independent.
TEST(Calibrate, ErrorsAreConsistentWithTheStandardDeviationsOverTwentySeeds) {
  double sum = 0.0, sum_of_means = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const CalibrationResult result = calibrate(record(wandering(2400), 6, kWorn, kNoise, seed), {}, {});
    ASSERT_THAT(not_observable(result), ::testing::IsEmpty());
    const Vector6 errors = normalized_errors(result, kWorn);
    EXPECT_LT(errors.cwiseAbs().maxCoeff(), 4.5) << seed;
    sum += errors.squaredNorm();
    sum_of_means += errors.mean();
    EXPECT_LT(result.parameters[kX].std, 0.002);
    EXPECT_LT(result.parameters[kDistance].std, 0.001);
    EXPECT_LT(result.parameters[kTurn].std, 0.002);
  }
  EXPECT_GT(sum / 120.0, 0.6);
  EXPECT_LT(sum / 120.0, 1.6);
  EXPECT_LT(std::abs(sum_of_means / 20.0), 4.0 / std::sqrt(120.0));
}

// Odometry's noise is in what explains: a scale from lidar on odometry would come out too small by noise^2 / turn^2 =
// (0.05 / 0.3)^2 = 3 %.
TEST(Calibrate, NoiseOfOdometryShrinksNoScale) {
  const test::Noise coarse{.odometry_m = 0.002, .odometry_rad = 0.02, .lidar_m = 0.001, .lidar_rad = 0.0005};
  const CalibrationResult result = calibrate(record(wandering(12000), 6, kWorn, coarse, 1), {}, {});
  EXPECT_LT(result.parameters[kTurn].std, 0.005);
  EXPECT_LT(std::abs(normalized_errors(result, kWorn)[kTurn]), 3.0);
}

TEST(Calibrate, OneReversedSegmentInFiveIsRejected) {
  std::vector<MotionSegment> pairs = record(wandering(2400), 6, kWorn, kNoise, 1);
  for (std::size_t k = 0; k < pairs.size(); k += 5) pairs[k].odometry.x *= -1.0;
  const CalibrationResult result = calibrate(pairs, {}, {});
  EXPECT_LT(normalized_errors(result, kWorn).cwiseAbs().maxCoeff(), 4.0);
  for (std::size_t k = 0; k < pairs.size(); k += 5) EXPECT_GT(result.errors[k], 5.0) << k;
  EXPECT_LE(result.num_rejected, 80 + 8) << "and of the others not more than one in forty";
}

TEST(Calibrate, StraightMotionDoesNotConstrainLeverArmAndRotationScale) {
  const Calibration truth{.override_lidar_pose = true,
                          .lidar_x_m = 0.25,
                          .lidar_yaw_rad = 0.03,
                          .distance_scale = 1.03,
                          .steering_bias_rad_per_m = 0.0};
  const CalibrationResult result =
      calibrate(record(repeated({0.1, 0.0, 0.0}, 1200), 5, truth, kNoise, 1), {0.1, 0.05, 0.0}, {});
  EXPECT_THAT(not_observable(result), ::testing::UnorderedElementsAre("lidar_x_m", "lidar_y_m", "turn_scale"));
  EXPECT_EQ(result.parameters[kX].value, 0.1) << "as before";
  EXPECT_EQ(result.parameters[kY].value, 0.05);
  EXPECT_EQ(result.parameters[kTurn].value, 1.0);
  EXPECT_GT(result.parameters[kX].std, 0.05);
  for (const std::size_t i : {kYaw, kDistance, kSteering})
    EXPECT_LT(std::abs(normalized_errors(result, truth)[static_cast<Eigen::Index>(i)]), 4.0) << i;
}

// Seen from a lidar on a circle, its direction and its heading turn together.
TEST(Calibrate, RotationInPlaceConstrainsRotationScaleAndLeverArmLengthOnly) {
  const Calibration truth{.override_lidar_pose = true, .lidar_x_m = 0.25, .lidar_yaw_rad = 0.03, .rotation_scale = 0.9};
  const CalibrationResult result = calibrate(record(repeated({0.0, 0.0, 0.06}, 1200), 6, truth, kNoise, 1), {}, {});
  EXPECT_THAT(not_observable(result),
              ::testing::UnorderedElementsAre("lidar_yaw_rad", "distance_scale", "steering_rad_per_m"));
  EXPECT_NEAR(std::hypot(result.parameters[kX].value, result.parameters[kY].value), 0.25,
              4.0 * result.parameters[kX].std);
  EXPECT_LT(std::abs(normalized_errors(result, truth)[kTurn]), 4.0);
}

TEST(Calibrate, OnACircleSteeringAndRotationScaleAreNotSeparable) {
  const CalibrationResult result = calibrate(record(repeated({0.1, 0.0, 0.1}, 1200), 5, kWorn, kNoise, 1), {}, {});
  EXPECT_THAT(not_observable(result),
              ::testing::AnyOf(::testing::Contains("steering_rad_per_m"), ::testing::Contains("turn_scale")));
}

TEST(Calibrate, FewerThanTwentySegmentsAreRefused) {
  try {
    calibrate(record(wandering(95), 5, kWorn, kNoise, 1), {}, {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "calibration needs at least 20 motion segments, got 19");
  }
}

}  // namespace
}  // namespace patrol::slam::calibrate_test
