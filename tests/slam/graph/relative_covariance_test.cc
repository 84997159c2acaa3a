#include "slam/graph/relative_covariance.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/random.h"
#include "tests/support/pose_near.h"

namespace patrol::slam::relative_covariance_test {
namespace {

constexpr double kExactTol = 1e-12;

Eigen::Matrix3d diagonal(double x, double y, double yaw) { return Eigen::Vector3d(x, y, yaw).asDiagonal(); }

/// Places a meter apart along x.
std::vector<Pose2> make_line(int count) {
  std::vector<Pose2> line;
  for (int i = 0; i < count; ++i) line.push_back({static_cast<double>(i), 0.0, 0.0});
  return line;
}

// From the origin, looking along y, with a tenth of a radian of doubt: 2 m ahead that is 0.2 m to the left, along -x;
// the way's own 0.3 m is ahead, along y.
TEST(ComposeCovariance, AHeadingErrorRotatesTheEdgeAndItsCovariance) {
  const PoseGaussian here{.mean = {0.0, 0.0, 0.5 * std::numbers::pi}, .covariance = diagonal(0.0, 0.0, 0.01)};
  const Eigen::Matrix3d there = compose_covariance(here, {0.0, 2.0, 0.5 * std::numbers::pi}, diagonal(0.09, 0.0, 0.0));
  EXPECT_NEAR(there(0, 0), 0.04, kExactTol);
  EXPECT_NEAR(there(1, 1), 0.09, kExactTol);
  EXPECT_NEAR(there(0, 2), -0.02, kExactTol);
  EXPECT_NEAR(there(2, 2), 0.01, kExactTol);
}

// Step i of n errs by a yaw that moves the end sideways by its rest: the variance is sigma^2 (1^2 + ... + (n-1)^2) + n
// q.
TEST(ShortestPathDistributions, AHeadingThatWandersOverTenMetersSpreadsTheEndAsTheSumOfSquares) {
  std::vector<CovarianceEdge> covariance_edges;
  for (int i = 0; i < 10; ++i) covariance_edges.push_back({i, i + 1, diagonal(0.01, 0.02, 0.001)});
  const PoseGaussian end = shortest_path_distributions(0, make_line(11), covariance_edges)[10];
  EXPECT_THAT(end.mean, test::Pose2Near(Pose2{10.0, 0.0, 0.0}, kExactTol, kExactTol));
  EXPECT_NEAR(end.covariance(0, 0), 10 * 0.01, kExactTol);
  EXPECT_NEAR(end.covariance(1, 1), 10 * 0.02 + 0.001 * 285.0, kExactTol);  // 1 + 4 + ... + 81
  EXPECT_NEAR(end.covariance(2, 2), 10 * 0.001, kExactTol);
  EXPECT_NEAR(end.covariance(1, 2), 0.001 * 45.0, kExactTol);
}

TEST(ShortestPathDistributions, ALoopClosureShortensThePathAndUnreachableNodesHaveInfiniteCovariance) {
  std::vector<CovarianceEdge> covariance_edges;
  for (int i = 0; i < 9; ++i) covariance_edges.push_back({i, i + 1, diagonal(0.01, 0.01, 0.0)});
  covariance_edges.push_back({9, 1, diagonal(1e-4, 1e-4, 0.0)});
  const std::vector<PoseGaussian> found = shortest_path_distributions(0, make_line(11), covariance_edges);
  EXPECT_NEAR(found[9].covariance(0, 0), 0.01 + 1e-4, kExactTol);
  EXPECT_NEAR(found[5].covariance(0, 0), 0.05, kExactTol);
  EXPECT_TRUE(std::isinf(found[10].covariance(0, 0)));
  EXPECT_EQ(found[0].covariance, Eigen::Matrix3d::Zero());
}

// A thousand draws of T_b_a, each turned round.
TEST(Invert, IsTheCovarianceOfInvertedPoses) {
  const PoseGaussian pose{.mean = {3.0, -2.0, 2.5}, .covariance = diagonal(4e-4, 1e-4, 2.5e-5)};
  const PoseGaussian inverse = invert(pose);
  const RandomStream draws(1, "test/inverse");
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  constexpr int kDraws = 100'000;
  for (std::uint64_t i = 0; i < kDraws; ++i) {
    const auto unit = draws.normals(i);
    const Pose2 rendered = perturbed(pose.mean, {0.02 * unit[0], 0.01 * unit[1], 0.005 * unit[2]}).inverse();
    const Eigen::Vector3d offset = inverse.residual_to_mean(rendered);
    sum += offset * offset.transpose();
  }
  EXPECT_LT((sum / kDraws - inverse.covariance).norm(), 0.01 * inverse.covariance.norm());
  EXPECT_THAT(invert(inverse).mean, test::Pose2Near(pose.mean, kExactTol, kExactTol));
  EXPECT_LT((invert(inverse).covariance - pose.covariance).norm(), kExactTol);
}

TEST(RotateCovariance, AQuarterRotationSwapsTheVariancesOfXAndY) {
  EXPECT_LT((rotate_covariance(diagonal(1.0, 4.0, 9.0), 0.5 * std::numbers::pi) - diagonal(4.0, 1.0, 9.0)).norm(),
            kExactTol);
}

}  // namespace
}  // namespace patrol::slam::relative_covariance_test
