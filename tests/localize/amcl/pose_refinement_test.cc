#include "localize/amcl/pose_refinement.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "tests/support/pose_near.h"
#include "tests/support/tunnel_world.h"

namespace patrol::localize::amcl_pose_refinement_test {
namespace {

using test::Pose2Near;

const slam::PoseGaussian kWide{.mean = {}, .covariance = Eigen::Vector3d(0.04, 0.04, 0.01).asDiagonal()};

slam::PoseGaussian wide_about(const Pose2& mean) { return {.mean = mean, .covariance = kWide.covariance}; }

const LineField& tunnel_lines() {
  static const LineField lines(test::tunnel_map(), 6);
  return lines;
}

LevelScan look(const test::RoomWorld& world, const Pose2& T_map_body, std::uint64_t tick = 0) {
  return world.scan(T_map_body, Time{}, test::kTunnelLidar, RandomStream(5, "test/look"), tick);
}

TEST(LineField, IsWhereTheWallIsAndNothingIsInTheMiddle) {
  EXPECT_EQ(tunnel_lines().find({50.0, 0.0}), nullptr);
  EXPECT_EQ(tunnel_lines().find({5000.0, 0.0}), nullptr);
  const SurfaceLine* line = tunnel_lines().find({50.0, 5.4});
  ASSERT_NE(line, nullptr);
  EXPECT_NEAR(std::abs(line->normal_map.y()), 1.0, 0.01);
  EXPECT_NEAR(line->point_map.y(), 5.5, 0.03);
}

TEST(RefinePose, RecoversTenCentimetersAndTwoDegreesToTwoCentimetersAndATenthOfADegree) {
  const test::Tunnel tunnel;
  const Pose2 truth{6.0, 0.4, 0.1};
  for (const double sign : {-1.0, 1.0}) {
    const Pose2 start{truth.x + sign * 0.1, truth.y - sign * 0.05, truth.yaw + sign * 2.0 * kDegree};
    const RefinedPose refined = refine_pose(tunnel_lines(), look(tunnel.world, truth), wide_about(start), start, {});
    EXPECT_TRUE(refined.is_matched);
    EXPECT_GT(refined.inlier_ratio, 0.95);
    EXPECT_THAT(refined.posterior.mean, Pose2Near(truth, 0.02, 0.1 * kDegree));
  }
}

// The tunnel runs along x: its walls tell y and heading, and 25 m around there is nothing that tells x.
TEST(RefinePose, LeavesTheDegenerateDirectionToThePrior) {
  const test::Tunnel tunnel;
  const Pose2 truth{62.0, 0.2, 0.03};
  const Pose2 start{truth.x + 0.2, truth.y + 0.05, truth.yaw};
  const RefinedPose refined = refine_pose(tunnel_lines(), look(tunnel.world, truth), wide_about(start), start, {});
  EXPECT_LT(refined.information(0, 0), 1.0);  // not even a meter
  EXPECT_NEAR(refined.posterior.mean.x, start.x, 1e-3);
  EXPECT_NEAR(std::sqrt(refined.posterior.covariance(0, 0)), 0.2, 0.01);
  EXPECT_NEAR(refined.posterior.mean.y, truth.y, 0.02);
  EXPECT_LT(std::sqrt(refined.posterior.covariance(1, 1)), 0.02);
}

// A truck, 9 m by 2.4 m, that the map does not know hides a fifth of the scan.
TEST(RefinePose, AnUnknownTruckPullsByLessThanOneCentimeter) {
  test::Tunnel tunnel;
  const Pose2 truth{6.0, 0.4, 0.1};
  const RefinedPose clear = refine_pose(tunnel_lines(), look(tunnel.world, truth), wide_about(truth), truth, {});
  tunnel.world.add_box(2.5, 1.4, 11.5, 3.8);
  const RefinedPose hidden = refine_pose(tunnel_lines(), look(tunnel.world, truth), wide_about(truth), truth, {});
  EXPECT_LT(hidden.inlier_ratio, 0.8);
  EXPECT_THAT(hidden.posterior.mean, Pose2Near(clear.posterior.mean, 0.01, 0.1 * kDegree));
}

TEST(RefinePose, WhereNothingFitsThePriorStays) {
  const test::Tunnel tunnel;
  const Pose2 start{30.0, 3.0, 0.8};
  const RefinedPose refined =
      refine_pose(tunnel_lines(), look(tunnel.world, {6.0, 0.4, 0.1}), wide_about(start), start, {});
  EXPECT_FALSE(refined.is_matched);
  EXPECT_EQ(refined.posterior.mean.vector(), start.vector());
  EXPECT_EQ(refined.posterior.covariance, kWide.covariance);
}

TEST(RefinePose, OfAnEmptyScanIsThePrior) {
  const RefinedPose refined = refine_pose(tunnel_lines(), {}, kWide, {}, {});
  EXPECT_FALSE(refined.is_matched);
  EXPECT_EQ(refined.num_points, 0);
}

// Information along y only, 100 / m^2; a spread of 0.1 m has as much: half the way in y, none in x.
TEST(ScanProposal, MovesAlongTheConstrainedDirection) {
  RefinedPose refined;
  refined.posterior.mean = {5.0, 1.0, 0.0};
  refined.information(1, 1) = 100.0;
  const ScanProposal proposal(refined, Eigen::Vector3d(0.01, 0.01, 0.01).asDiagonal());
  EXPECT_THAT(proposal.sample({4.0, 0.0, 0.2}, Eigen::Vector3d::Zero()), Pose2Near((Pose2{4.0, 0.5, 0.2}), 1e-9, 1e-9));
  const Pose2 drawn = proposal.sample({4.0, 0.0, 0.2}, {1.0, 1.0, 0.0});
  EXPECT_NEAR(drawn.x, 4.1, 1e-9);
  EXPECT_NEAR(drawn.y, 0.5 + std::sqrt(0.005), 1e-9);
}

}  // namespace
}  // namespace patrol::localize::amcl_pose_refinement_test
