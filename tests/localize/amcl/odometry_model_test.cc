#include "localize/amcl/odometry_model.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/pose_near.h"

namespace patrol::localize::amcl_odometry_model_test {
namespace {

constexpr int kParticles = 2000;
const Pose2 kStep{0.2, 0.0, 0.0};

struct Spread {
  double along_std, scale_std;
};

/// Spread after `steps` steps of 0.2 m along x from one pose.
Spread spread_after(int steps, const OdometryModelSettings& settings) {
  const RandomStream noise(1, "test/motion"), start(2, "test/start");
  ParticleCloud cloud;
  for (std::uint64_t i = 0; i < kParticles; ++i) cloud.add({}, settings.scale_std * start.normal(0, i));
  for (int step = 0; step < steps; ++step)
    propagate_particles(cloud, kStep, 0.2, settings, noise, static_cast<std::uint64_t>(step));
  double sum = 0.0, squares = 0.0, scales = 0.0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    sum += cloud.T_map_body[i].x, squares += cloud.T_map_body[i].x * cloud.T_map_body[i].x,
        scales += cloud.odometry_scale[i] * cloud.odometry_scale[i];
  }
  return {std::sqrt(squares / kParticles - std::pow(sum / kParticles, 2)), std::sqrt(scales / kParticles)};
}

OdometryModelSettings only_scale() {
  OdometryModelSettings settings;
  settings.noise = {0.0, 0.0, 0.0, 0.0, 0.0, 1e-6, 1e-6};
  return settings;
}

// Gauss-Markov scale s of deviation S and memory L: var of the way D is 2 S^2 L (D - L (1 - exp(-D / L))). For S = 2 %,
// L = 50 m that is 0.375 m after 20 m and 0.707 m after 40 m: nearly twice as much for twice the way.
TEST(OdometryModel, ASystematicScaleErrorSpreadsTheParticlesWithTheDistanceAndNotWithItsRoot) {
  const auto expected = [](double way_m) {
    return 0.02 * std::sqrt(2.0 * 50.0 * (way_m - 50.0 * (1.0 - std::exp(-way_m / 50.0))));
  };
  constexpr double kTol = 4.0 / 63.2;  // 4 / sqrt(2 n), of a standard deviation from 2,000 draws
  EXPECT_NEAR(spread_after(100, only_scale()).along_std / expected(20.0), 1.0, kTol);
  EXPECT_NEAR(spread_after(200, only_scale()).along_std / expected(40.0), 1.0, kTol);
  EXPECT_GT(expected(40.0), 1.85 * expected(20.0));
}

TEST(OdometryModel, TheScaleKeepsItsDeviation) {
  EXPECT_NEAR(spread_after(500, only_scale()).scale_std, 0.02, 0.02 * 4.0 / 63.2);
}

TEST(OdometryModel, WithoutScaleTheSpreadGrowsWithTheRoot) {
  OdometryModelSettings settings = only_scale();
  settings.scale_std = 0.0;
  settings.noise.longitudinal_std_m_per_m = 0.01;
  EXPECT_NEAR(spread_after(100, settings).along_std, 0.002 * std::sqrt(100.0), 0.02 * 4.0 / 63.2);
}

// 2 m ahead with 2 % of scale, and a heading known to 0.1 rad: 4 cm along, 20 cm across.
TEST(OdometryModel, AGaussianIsMovedAsTheParticlesAre) {
  const slam::PoseGaussian before{.mean = {}, .covariance = Eigen::Vector3d(0.0, 0.0, 0.01).asDiagonal()};
  const slam::PoseGaussian now = predict(before, {2.0, 0.0, 0.3}, 1.0, only_scale());
  EXPECT_THAT(now.mean, test::Pose2Near((Pose2{2.0, 0.0, 0.3}), 1e-12, 1e-12));
  EXPECT_NEAR(std::sqrt(now.covariance(0, 0)), 0.04, 1e-6);
  EXPECT_NEAR(std::sqrt(now.covariance(1, 1)), 0.2, 1e-6);
}

TEST(OdometryModel, TheSameTickGivesTheSameSamplesAndAnotherDifferentOnes) {
  const RandomStream noise(1, "test/motion");
  const auto draw = [&](std::uint64_t tick) {
    ParticleCloud cloud;
    cloud.add({}, 0.0);
    propagate_particles(cloud, kStep, 0.2, {}, noise, tick);
    return cloud.T_map_body.front().vector();
  };
  EXPECT_EQ(draw(3), draw(3));
  EXPECT_NE(draw(3), draw(4));
}

}  // namespace
}  // namespace patrol::localize::amcl_odometry_model_test
