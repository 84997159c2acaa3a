#include "slam/rbpf/proposal.h"

#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "slam/scan_integration.h"
#include "tests/support/pose_near.h"
#include "tests/support/room_world.h"

namespace patrol::slam::proposal_test {
namespace {

using test::Pose2Near, test::RoomWorld;

const Pose2 kTruth{0.3, 0.2, 0.1};

RoomWorld make_room() {
  RoomWorld room;
  room.add_box(-3.0, -2.0, 5.0, 4.0).add_box(3.5, -2.0, 5.0, -1.0);
  return room;
}

GridMap make_map() {
  GridMap map(0.05, 100.0);
  for (int i = 0; i < 3; ++i) integrate_scan(make_room().scan({}, {}), {}, {}, map);
  return map;
}

std::vector<MatchPoint> look() { return downsample_scan(make_room().scan(kTruth, {}), 0.08, 800); }

PoseGaussian around(const Pose2& mean) {
  return {.mean = mean, .covariance = Eigen::Vector3d(0.01, 0.01, 0.0025).asDiagonal()};
}

Proposal propose(const PoseGaussian& prediction, double gain) {
  return laplace_proposal(make_map(), look(), prediction.mean, prediction, gain, {});
}

TEST(LaplaceProposal, MovesToTheMatchAndHasASmallerCovarianceThanOdometry) {
  const PoseGaussian prediction = around({kTruth.x + 0.05, kTruth.y - 0.03, kTruth.yaw + 0.02});
  const Proposal proposal = propose(prediction, 0.02);
  EXPECT_THAT(proposal.posterior.mean, Pose2Near(kTruth, 0.005, 0.002));
  EXPECT_GT(proposal.inlier_ratio, 0.9);
  for (int i = 0; i < 3; ++i) EXPECT_LT(proposal.posterior.covariance(i, i), 0.1 * prediction.covariance(i, i)) << i;
}

// Sigma^-1 = P^-1 + g H for two gains: the difference over the gains' is H, and at g = 0 only P is left.
TEST(LaplaceProposal, InformationIsProportionalToTheTempering) {
  const PoseGaussian prediction = around(kTruth);
  const Eigen::Matrix3d P_inverse = prediction.covariance.inverse();
  const Eigen::Matrix3d once = propose(prediction, 0.01).posterior.covariance.inverse() - P_inverse;
  const Eigen::Matrix3d thrice = propose(prediction, 0.03).posterior.covariance.inverse() - P_inverse;
  EXPECT_TRUE(thrice.isApprox(3.0 * once, 1e-6));
  EXPECT_TRUE(propose(prediction, 0.0).posterior.covariance.isApprox(prediction.covariance, 1e-9));
}

TEST(LaplaceProposal, WithoutAMapStaysWithOdometry) {
  const PoseGaussian prediction = around({0.5, 0.0, 0.0});
  const Proposal proposal = laplace_proposal(GridMap(0.05, 100.0), look(), prediction.mean, prediction, 0.02, {});
  EXPECT_THAT(proposal.posterior.mean, Pose2Near(prediction.mean, 0.0, 0.0));
  EXPECT_EQ(proposal.posterior.covariance, prediction.covariance);
  EXPECT_EQ(proposal.log_weight_increment, 0.0);
  EXPECT_EQ(proposal.inlier_ratio, 0.0);
}

// Two predictions, one right and one 10 cm (one standard deviation) off: same match, weight lower by 1/2.
TEST(LaplaceProposal, OneStandardDeviationOffCostsHalfANat) {
  const double right = propose(around(kTruth), 0.02).log_weight_increment;
  const double off = propose(around({kTruth.x + 0.1, kTruth.y, kTruth.yaw}), 0.02).log_weight_increment;
  EXPECT_NEAR(right - off, 0.5, 0.05);
}

TEST(ProposalSample, WithoutNoiseIsTheMean) {
  const Proposal proposal{.posterior = around({1.0, 2.0, 3.1})};
  EXPECT_THAT(proposal.sample(Eigen::Vector3d::Zero()), Pose2Near((Pose2{1.0, 2.0, 3.1}), 1e-12, 1e-12));
  EXPECT_THAT(proposal.sample({1.0, 0.0, 1.0}), Pose2Near((Pose2{1.1, 2.0, 3.15}), 1e-12, 1e-12));
}

}  // namespace
}  // namespace patrol::slam::proposal_test
