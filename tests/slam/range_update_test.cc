#include "slam/range_update.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/random.h"

namespace patrol::slam::range_update_test {
namespace {

const Eigen::Vector3d kAntenna(0.2, -0.1, 0.8);
const UwbAnchor kAnchor{.number = 1, .p_m = {12.0, 5.0, 2.5}};

PoseGaussian belief(const Pose2& mean, double std_m, double std_rad) {
  return {.mean = mean, .covariance = Eigen::Vector3d(std_m * std_m, std_m * std_m, std_rad * std_rad).asDiagonal()};
}

/// Range at a pose, without noise.
RangeMeasurement measurement_at(const Pose2& T_map_body, const Pose2& T_odom_body) {
  return {.anchor = kAnchor,
          .range_m = predict_uwb_range(kAnchor, T_map_body, kAntenna, {}).range_m,
          .T_odom_body = T_odom_body,
          .p_level_antenna = kAntenna};
}

TEST(RangeUpdate, TheGradientIsThatOfFiniteDifferences) {
  const Pose2 T_odom_then{1.0, 2.0, 0.3}, T_odom_now{2.0, 1.5, 0.9};
  const RangeMeasurement measurement = measurement_at({3.0, 1.0, 0.5}, T_odom_then);
  const PoseGaussian now = belief({4.0, 0.5, 1.1}, 0.1, 0.05);
  const RangeInnovation innovation = range_innovation(now, T_odom_now, measurement, {});
  constexpr double kStep = 1e-6;
  for (int axis = 0; axis < 3; ++axis) {
    PoseGaussian moved = now;
    moved.mean = perturbed(now.mean, kStep * Eigen::Vector3d::Unit(axis));
    const double change = innovation.innovation_m - range_innovation(moved, T_odom_now, measurement, {}).innovation_m;
    EXPECT_NEAR(innovation.H_pose[axis], change / kStep, 1e-4) << axis;
  }
}

TEST(RangeUpdate, ARangeShrinksTheBeliefTowardsItsAnchorAndLeavesItAcross) {
  const Pose2 truth{0.0, 0.0, 0.0};
  PoseGaussian now = belief(truth, 1.0, 1e-6);
  update_with_ranges({measurement_at(truth, {})}, {}, {.range_std_m = 0.1}, now);
  const Eigen::Vector3d to_anchor = kAnchor.p_m - Eigen::Vector3d(0.2, -0.1, 0.8);
  const Eigen::Vector2d along = to_anchor.head<2>() / to_anchor.norm(), across(-along.y(), along.x());
  const Eigen::Matrix2d P = now.covariance.topLeftCorner<2, 2>();
  const double h2 = along.squaredNorm();  // Kalman: 1 / (1 + h^2 / r^2) of the variance stays along h
  EXPECT_NEAR(along.normalized().dot(P * along.normalized()), 1.0 / (1.0 + h2 / 0.01), 1e-3);
  EXPECT_NEAR(across.normalized().dot(P * across.normalized()), 1.0, 1e-3);
}

// Ranges that are normally distributed about the truth: the squared innovations over their variances average to 1.
TEST(RangeUpdate, InnovationsOf500RangesAreConsistent) {
  const RandomStream stream(3, "test/ranges");
  double sum = 0.0;
  constexpr int kCount = 500;
  for (std::uint64_t i = 0; i < kCount; ++i) {
    const Pose2 truth{1.0, -2.0, 0.4};
    PoseGaussian now =
        belief(perturbed(truth, {0.2 * stream.normal(i, 0), 0.2 * stream.normal(i, 1), 0.02 * stream.normal(i, 2)}),
               0.2, 0.02);
    RangeMeasurement measurement = measurement_at(truth, {});
    measurement.range_m += 0.15 * stream.normal(i, 3);
    const RangeInnovation innovation = range_innovation(now, {}, measurement, {.range_std_m = 0.15});
    sum += innovation.innovation_m * innovation.innovation_m / innovation.variance_m2;
  }
  EXPECT_NEAR(sum / kCount, 1.0, 2.58 * std::sqrt(2.0 / kCount));  // 99 % of chi-square's mean
}

TEST(RangeUpdate, ALongRangeIsRejectedSoonerThanAShortOne) {
  const RangeUpdateSettings settings{.range_std_m = 0.1};
  const auto verdict = [&](double deviations) {
    return passes_gate({.innovation_m = 0.1 * deviations, .variance_m2 = 0.01}, settings);
  };
  EXPECT_TRUE(verdict(1.9));
  EXPECT_FALSE(verdict(2.1));
  EXPECT_TRUE(verdict(-2.9));
  EXPECT_FALSE(verdict(-3.1));
}

}  // namespace
}  // namespace patrol::slam::range_update_test
