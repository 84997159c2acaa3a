#include "localize/amcl/global_search.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/tunnel_world.h"

namespace patrol::localize::amcl_global_search_test {
namespace {

constexpr double kBeams = 20.0;  // that a scan counts for

const GlobalSearch& tunnel_search() {
  static const LineField lines(test::tunnel_map(), 6);
  static const GlobalSearch global_localization({}, {}, test::tunnel_map(), lines);
  return global_localization;
}

GlobalSearch::Candidates find(const Pose2& truth, const std::vector<AnchoredRange>& ranges = {}) {
  const test::Tunnel tunnel;
  const LevelScan scan = tunnel.world.scan(truth, Time{}, test::kTunnelLidar, RandomStream(3, "test/look"), 0);
  return tunnel_search().find(scan, ranges, {}, kBeams, 0.5);
}

/// Share of the weight within half a meter and 10 degrees.
double weight_near(const GlobalSearch::Candidates& candidates, const Pose2& pose) {
  double weight = 0.0;
  for (std::size_t i = 0; i < candidates.weights.size(); ++i) {
    const Pose2& candidate = candidates.T_map_body[i];
    const bool is_near =
        (candidate.position() - pose.position()).norm() < 0.5 && std::abs(wrap_angle(candidate.yaw - pose.yaw)) < 0.17;
    if (is_near) weight += candidates.weights[i];
  }
  return weight;
}

TEST(GlobalSearch, FindsPortalAndRockFromOneScan) {
  EXPECT_GT(weight_near(find({6.0, 0.4, 0.1}), {6.0, 0.4, 0.1}), 0.9);
  EXPECT_GT(weight_near(find({124.0, -1.0, 2.0}), {124.0, -1.0, 2.0}), 0.9);
}

// Nothing to be seen but two walls: 48 m of the lined stretch look like this, in both directions.
TEST(GlobalSearch, StaysUndecidedInTheLinedStretch) {
  const Pose2 truth{62.0, 0.0, 0.0};
  const GlobalSearch::Candidates candidates = find(truth);
  EXPECT_LT(weight_near(candidates, truth), 0.1);
  double forward = 0.0, x = 0.0, xx = 0.0;
  for (std::size_t i = 0; i < candidates.weights.size(); ++i) {
    const double weight = candidates.weights[i];
    forward += std::abs(candidates.T_map_body[i].yaw) < 1.0 ? weight : 0.0;
    x += weight * candidates.T_map_body[i].x, xx += weight * candidates.T_map_body[i].x * candidates.T_map_body[i].x;
  }
  EXPECT_NEAR(forward, 0.5, 0.2);
  EXPECT_GT(std::sqrt(xx - x * x), 10.0);  // evenly over 48 m: 13.9 m
}

// Three anchors leave one place; the direction stays open, for the antenna is on the axis.
TEST(GlobalSearch, RangesDecideWhereTheScanCannot) {
  const Pose2 truth{62.0, 0.3, 0.0};
  std::vector<AnchoredRange> ranges;
  for (const Eigen::Vector3d& anchor :
       {Eigen::Vector3d(45.0, 5.5, 2.5), Eigen::Vector3d(60.0, -5.5, 2.5), Eigen::Vector3d(75.0, 5.5, 2.5)}) {
    ranges.push_back({anchor, Eigen::Vector3d::Zero(), (anchor - Eigen::Vector3d(truth.x, truth.y, 0.0)).norm()});
  }
  const GlobalSearch::Candidates candidates = find(truth, ranges);
  EXPECT_GT(weight_near(candidates, truth) + weight_near(candidates, {truth.x, truth.y, std::numbers::pi}), 0.9);
}

TEST(GlobalSearch, SamplesTheRequestedNumberOfPosesNearTheCandidates) {
  const GlobalSearch::Candidates candidates = find({6.0, 0.4, 0.1});
  const std::vector<Pose2> poses = sample_poses(candidates, 200, RandomStream(1, "test/draw"), 0);
  ASSERT_EQ(poses.size(), 200U);
  const auto near = std::count_if(poses.begin(), poses.end(),
                                  [](const Pose2& pose) { return std::hypot(pose.x - 6.0, pose.y - 0.4) < 0.6; });
  EXPECT_GT(near, 180);
  EXPECT_TRUE(sample_poses({}, 200, RandomStream(1, "test/draw"), 0).empty());
}

TEST(GlobalSearch, AMapSmallerThanTheGridStepHasACandidate) {
  OccupancyGrid map({.resolution_m = 0.05, .width = 3, .height = 3}, kOccupied);
  map.at({1, 1}) = kFree;
  const LineField lines(map, 6);
  EXPECT_FALSE(GlobalSearch({}, {}, map, lines).find({}, {}, {}, kBeams, 0.5).weights.empty());
}

}  // namespace
}  // namespace patrol::localize::amcl_global_search_test
