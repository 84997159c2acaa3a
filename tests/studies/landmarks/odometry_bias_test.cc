#include "studies/landmarks/odometry_bias.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/random.h"
#include "tests/support/pose_near.h"

namespace patrol::studies::odometry_bias_test {
namespace {

using test::VectorNear;

constexpr double kExactTol = 1e-12;

// Increments of unit variance about the bias: information adds up, 1 / variance = 1 / P + n; and the mean is sum / (1 /
// P + n).
TEST(OdometryBias, AfterNIncrementsTheVarianceIsOneOverTheInformation) {
  const OdometryBiasSettings settings{.std = 2.0};
  OdometryBias bias(settings);
  EXPECT_LT((bias.covariance - 4.0 * Eigen::Matrix2d::Identity()).norm(), kExactTol);
  const RandomStream stream(1, "test/increments");
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int n = 1; n <= 50; ++n) {
    const auto draw = stream.normals(static_cast<std::uint64_t>(n));
    const Eigen::Vector2d increment(draw[0] + 1.0, draw[1] - 0.5);
    bias.add_increment(increment, settings);
    sum += increment;
    EXPECT_LT((bias.covariance - Eigen::Matrix2d::Identity() / (0.25 + n)).norm(), kExactTol) << n;
    EXPECT_THAT(bias.mean, VectorNear(Eigen::Vector2d(sum / (0.25 + n)), kExactTol)) << n;
  }
}

TEST(OdometryBias, WithoutUncertaintyLearnsNothing) {
  OdometryBias bias;
  bias.add_increment({3.0, -2.0}, {});
  EXPECT_EQ(bias.mean, Eigen::Vector2d::Zero());
  EXPECT_EQ(bias.covariance, Eigen::Matrix2d::Zero());
  EXPECT_EQ(bias.increment_covariance(), Eigen::Matrix2d::Identity());
}

TEST(OdometryBias, IncrementsVarianceIsOneMoreThanTheBiass) {
  EXPECT_LT((OdometryBias({.std = 2.0}).increment_covariance() - 5.0 * Eigen::Matrix2d::Identity()).norm(), kExactTol);
}

TEST(OdometryBias, RootTimesItsTransposeIsTheIncrementsCovariance) {
  OdometryBias bias;
  bias.covariance << 0.7, -0.3, -0.3, 0.4;
  const Eigen::Matrix2d root = bias.increment_root();
  EXPECT_LT((root * root.transpose() - bias.increment_covariance()).norm(), kExactTol);
  EXPECT_EQ(root(0, 1), 0.0);
}

// A bias that wanders: P = P / (P + 1) + q^2 stands still at P = (q^2 + q sqrt(q^2 + 4)) / 2; here q = 0.1: 0.105125.
TEST(OdometryBias, ThatWandersATenthEachStepHasTheSteadyStateVariance) {
  const OdometryBiasSettings settings{.std = 2.0, .walk_std = 0.1};
  OdometryBias bias(settings);
  for (int n = 0; n < 200; ++n) bias.add_increment({1.0, -1.0}, settings);
  const double steady = 0.5 * (0.01 + 0.1 * std::sqrt(0.01 + 4.0));
  EXPECT_LT((bias.covariance - steady * Eigen::Matrix2d::Identity()).norm(),
            1e-9);                                                       // (1 - gain)^400 of the start is left
  EXPECT_THAT(bias.mean, VectorNear(Eigen::Vector2d(1.0, -1.0), 1e-6));  // (1 - gain)^200 = 2e-9
}

}  // namespace
}  // namespace patrol::studies::odometry_bias_test
