#include "core/uwb.h"

#include <numbers>

#include <gtest/gtest.h>

namespace patrol::uwb_test {
namespace {

constexpr double kExactTol = 1e-12;
constexpr double kDerivativeTol = 1e-6;  // central difference over 1e-4
const UwbCalibration kUnbiased{.distance_m = {}, .bias_m = {}};
constexpr double kPi = std::numbers::pi;

TEST(Uwb, ThreeFourTwelveIsThirteenAndTheBiasComesOnTop) {
  const UwbAnchor anchor{.number = 7, .p_m = {3.0, 4.0, 12.0}};
  EXPECT_NEAR(predict_uwb_range(anchor, {}, {0, 0, 0}, kUnbiased).range_m, 13.0, kExactTol);
  // Halfway from 0.2 to 0.4.
  const UwbCalibration biased{.distance_m = {10.0, 16.0}, .bias_m = {0.2, 0.4}};
  EXPECT_NEAR(predict_uwb_range(anchor, {}, {0, 0, 0}, biased).range_m, 13.3, kExactTol);
}

TEST(Uwb, BiasIsLevelBeyondTheEndsOfItsTable) {
  const UwbCalibration biased{.distance_m = {10.0, 16.0}, .bias_m = {0.2, 0.4}};
  EXPECT_NEAR(uwb_bias_at(biased, 1.0).bias_m, 0.2, kExactTol);
  EXPECT_NEAR(uwb_bias_at(biased, 100.0).bias_m, 0.4, kExactTol);
  EXPECT_NEAR(uwb_bias_at(biased, 100.0).slope, 0.0, kExactTol);
  EXPECT_NEAR(uwb_bias_at(biased, 16.0).bias_m, 0.4, kExactTol);
}

TEST(Uwb, AntennaBehindTheBodyTurnsWithIt) {
  const UwbAnchor anchor{.p_m = {0.0, 10.0, 0.0}};
  // Facing the anchor, the antenna half a metre behind: 10.5 m; facing away: 9.5 m.
  EXPECT_NEAR(predict_uwb_range(anchor, {0, 0, kPi / 2}, {-0.5, 0, 0}, kUnbiased).range_m, 10.5, kExactTol);
  EXPECT_NEAR(predict_uwb_range(anchor, {0, 0, -kPi / 2}, {-0.5, 0, 0}, kUnbiased).range_m, 9.5, kExactTol);
}

TEST(Uwb, GradientIsTheDifferenceQuotient) {
  const UwbAnchor anchor{.p_m = {7.0, -3.0, 2.5}};
  const UwbCalibration calibration{.distance_m = {5.0, 15.0}, .bias_m = {0.1, 0.3}};
  const Eigen::Vector3d antenna(-0.3, 0.2, 0.6);
  const Pose2 pose{1.0, 2.0, 0.7};
  const auto range = [&](double dx, double dy, double dyaw, double dz) {
    return predict_uwb_range(anchor, {pose.x + dx, pose.y + dy, pose.yaw + dyaw}, antenna + Eigen::Vector3d(0, 0, dz),
                             calibration)
        .range_m;
  };
  const PredictedRange predicted = predict_uwb_range(anchor, pose, antenna, calibration);
  const double h = 1e-4;
  EXPECT_NEAR(predicted.H_pose.x(), (range(h, 0, 0, 0) - range(-h, 0, 0, 0)) / (2 * h), kDerivativeTol);
  EXPECT_NEAR(predicted.H_pose.y(), (range(0, h, 0, 0) - range(0, -h, 0, 0)) / (2 * h), kDerivativeTol);
  EXPECT_NEAR(predicted.H_pose.z(), (range(0, 0, h, 0) - range(0, 0, -h, 0)) / (2 * h), kDerivativeTol);
  EXPECT_NEAR(predicted.H_z, (range(0, 0, 0, h) - range(0, 0, 0, -h)) / (2 * h), kDerivativeTol);
}

TEST(Uwb, OnTheAnchorItselfTheGradientIsZeroAndNotNaN) {
  const PredictedRange predicted = predict_uwb_range({.p_m = {1.0, 2.0, 0.5}}, {1.0, 2.0, 0.3}, {0, 0, 0.5}, kUnbiased);
  EXPECT_NEAR(predicted.range_m, 0.0, kExactTol);
  EXPECT_EQ(predicted.H_pose, Eigen::Vector3d::Zero());
}

TEST(Uwb, PitchOfTenDegreesMovesAnAntennaOneMetreUpAheadBySineTen) {
  const Eigen::Quaterniond tilted = quaternion_from_rpy(0.0, kPi / 18.0, 2.0);
  const Eigen::Vector3d antenna = uwb_antenna_in_level(tilted, {{0, 0, 1.0}, Eigen::Quaterniond::Identity()}, 0.3);
  EXPECT_NEAR(antenna.x(), std::sin(kPi / 18.0), kExactTol);
  EXPECT_NEAR(antenna.y(), 0.0, kExactTol);
  EXPECT_NEAR(antenna.z(), 0.3 + std::cos(kPi / 18.0), kExactTol);
}

}  // namespace
}  // namespace patrol::uwb_test
