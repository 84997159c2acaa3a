#include "localize/amcl/kld.h"

#include <numbers>

#include <gtest/gtest.h>

#include "localize/amcl/particle_cloud.h"
#include "tests/support/pose_near.h"

namespace patrol::localize::amcl_kld_test {
namespace {

constexpr KldSettings kFree{.min_particles = 1, .max_particles = 1000000};

// Twice max_kl_divergence times the particles is the chi-square quantile of bins - 1 degrees of freedom. Tables: 0.99
// quantiles 23.209 (10), 76.154 (50), 135.807 (100); Wilson and Hilferty come within one percent.
TEST(KldParticles, AreTheChiSquareQuantileOverTwiceTheError) {
  EXPECT_NEAR(kld_particles(11, kFree), 23.209 / 0.1, 3.0);
  EXPECT_NEAR(kld_particles(51, kFree), 76.154 / 0.1, 3.0);
  EXPECT_NEAR(kld_particles(101, kFree), 135.807 / 0.1, 3.0);
}

TEST(KldParticles, StayWithinTheirLimits) {
  EXPECT_EQ(kld_particles(0, {}), 300);
  EXPECT_EQ(kld_particles(1, {}), 300);
  EXPECT_EQ(kld_particles(100000, {}), 5000);
}

TEST(KldParticles, GrowWithTheBinsAndFallWithTheError) {
  EXPECT_LT(kld_particles(50, kFree), kld_particles(51, kFree));
  EXPECT_LT(kld_particles(50, {.max_kl_divergence = 0.1, .min_particles = 1}), kld_particles(50, kFree));
}

TEST(PoseBins, AreOfPositionAndHeading) {
  PoseBins bins({.bin_m = 0.5, .bin_rad = 0.2});
  EXPECT_EQ(bins.add({0.1, 0.1, 0.0}), 0U);
  EXPECT_EQ(bins.add({0.4, 0.4, 0.0}), 0U);
  EXPECT_EQ(bins.add({-0.1, 0.1, 0.0}), 1U);
  EXPECT_EQ(bins.add({0.1, 0.1, 1.0}), 2U);
  EXPECT_EQ(bins.size(), 3U);
}

TEST(PoseBins, ClusterWhenAdjacentAlsoAcrossTheAngleWrap) {
  PoseBins bins({.bin_m = 0.5, .bin_rad = 0.1745});
  bins.add({0.1, 0.1, std::numbers::pi - 0.01});
  bins.add({0.6, 0.6, -std::numbers::pi + 0.01});
  bins.add({5.0, 0.1, 0.0});
  bins.add({1.1, 1.1, -std::numbers::pi + 0.2});
  EXPECT_EQ(bins.clusters(), (std::vector<std::size_t>{0, 0, 2, 0}));
}

TEST(ParticleCloud, TheDominantClusterIsDescribedAndNotTheOthers) {
  const std::vector<Pose2> poses = {{0.0, 0.0, 3.1}, {0.2, 0.0, -3.1}, {20.0, 0.0, 0.0}};
  const std::vector<double> weights = {0.3, 0.3, 0.4};
  const std::vector<std::size_t> clusters = cluster_particles(poses, {});
  const ParticleCluster dominant = find_dominant_cluster(clusters, weights);
  EXPECT_NEAR(dominant.weight, 0.6, 1e-12);
  const slam::PoseGaussian gaussian = cluster_gaussian(poses, weights, clusters, dominant.number);
  EXPECT_THAT(gaussian.mean, test::Pose2Near((Pose2{0.1, 0.0, std::numbers::pi}), 1e-9, 1e-9));
  EXPECT_NEAR(gaussian.covariance(0, 0), 0.01, 1e-12);  // 0.1^2 either side
  EXPECT_NEAR(gaussian.covariance(2, 2), std::pow(std::numbers::pi - 3.1, 2), 1e-9);
}

// The heaviest of the clusters near a pose, not the heaviest of all: one is 20 m off, one is turned by half a turn.
TEST(ParticleCloud, TheClusterThatContinuesAPoseIsWithinThreeSigmasAndThreeMeters) {
  const std::vector<Pose2> poses = {{0.0, 0.0, 0.0}, {2.8, 0.0, 0.0}, {0.0, 0.0, 3.0}, {20.0, 0.0, 0.0}};
  const std::vector<double> weights = {0.1, 0.2, 0.3, 0.4};
  const std::vector<std::size_t> clusters = cluster_particles(poses, {});
  slam::PoseGaussian pose{.mean = {}, .covariance = Eigen::Matrix3d::Zero()};
  const auto near = [&] { return find_cluster_near(pose, poses, clusters, weights); };
  EXPECT_EQ(near().value().number, clusters[1]);
  EXPECT_NEAR(near().value().weight, 0.2, 1e-12);
  pose.mean.x = -10.0;
  EXPECT_FALSE(near().has_value());
  pose.covariance(0, 0) = 144.0;
  EXPECT_EQ(near().value().number, clusters[3]) << "30 m are 2.5 sigmas";
  pose = {.mean = {20.0, 0.0, 0.0}, .covariance = Eigen::Matrix3d::Zero()};
  EXPECT_FALSE(find_cluster_near(pose, poses, clusters, {0.5, 0.5, 0.0, 0.0}).has_value()) << "its weight is gone";
}

}  // namespace
}  // namespace patrol::localize::amcl_kld_test
