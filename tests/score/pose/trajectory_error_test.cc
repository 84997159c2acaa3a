#include "score/pose/trajectory_error.h"

#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "tests/support/pose_near.h"

namespace patrol::score::trajectory_error_test {
namespace {

using namespace std::chrono_literals;
using test::Pose2Near, test::Pose3Near;

constexpr double kExactTol = 1e-9;

/// Steps of a quarter of a metre, ten a second, each pose changed by `change(i, pose)`.
Trajectory make_trajectory(const std::vector<Pose2>& poses, const std::function<Pose2(int, const Pose2&)>& change) {
  Trajectory trajectory;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const int index = static_cast<int>(i);
    trajectory.push_back({index * 100ms, to_pose3(change(index, poses[i]), 0.3)});
  }
  return trajectory;
}
Trajectory make_trajectory(const std::vector<Pose2>& poses) {
  return make_trajectory(poses, [](int, const Pose2& pose) { return pose; });
}

/// `steps` steps of 0.25 m along x from (2, 3).
std::vector<Pose2> straight(int steps) {
  std::vector<Pose2> poses;
  for (int i = 0; i <= steps; ++i) poses.push_back({2.0 + 0.25 * i, 3.0, 0.0});
  return poses;
}

/// 10 m east, then 10 m north.
std::vector<Pose2> corner() {
  std::vector<Pose2> poses = straight(40);
  for (int i = 0; i <= 40; ++i) poses.push_back({12.0, 3.0 + 0.25 * i, std::numbers::pi / 2.0});
  return poses;
}

TEST(TrajectoryError, OfThreeByFourCentimetresBesideIsFiveEverywhereAndNoneFromMetreToMetre) {
  const Trajectory truth = make_trajectory(corner());
  const Trajectory estimate = make_trajectory(corner(), [](int, const Pose2& p) {
    return Pose2{p.x + 0.03, p.y - 0.04, p.yaw};
  });
  const TrajectoryError error = trajectory_error(estimate, {}, truth);
  EXPECT_EQ(error.num_poses, 82U);
  EXPECT_NEAR(error.ate_rmse_m, 0.05, kExactTol);
  EXPECT_NEAR(error.ate_mean_m, 0.05, kExactTol);
  EXPECT_NEAR(error.ate_max_m, 0.05, kExactTol);
  EXPECT_NEAR(error.heading_rmse_deg, 0.0, kExactTol);
  EXPECT_NEAR(error.rpe_trans_1m_m, 0.0, kExactTol);
  EXPECT_NEAR(error.rpe_rot_1m_deg, 0.0, kExactTol);
}

// A chord of the turn: 2 s sin(alpha / 2) after s metres. For s = 0, 0.25 ... 10 the mean square of s is
// 0.25^2 n (2 n + 1) / 6 with n = 40.
TEST(TrajectoryError, OfOneDegreeAtTheStartGrowsInProportionToTheWay) {
  const Pose2 T_world_map{2.0, 3.0, 1.0 * kDegree};
  const Trajectory truth = make_trajectory(straight(40));
  const Trajectory estimate = make_trajectory(straight(40), [](int, const Pose2& p) {
    return Pose2{p.x - 2.0, p.y - 3.0, p.yaw};
  });
  const TrajectoryError error = trajectory_error(estimate, T_world_map, truth);
  const double chord = 2.0 * std::sin(0.5 * kDegree), mean_square = 0.0625 * 40.0 * 81.0 / 6.0;
  EXPECT_NEAR(error.ate_max_m, 10.0 * chord, kExactTol);
  EXPECT_NEAR(error.ate_rmse_m, chord * std::sqrt(mean_square), kExactTol);
  EXPECT_NEAR(error.heading_rmse_deg, 1.0, kExactTol);
  EXPECT_NEAR(error.rpe_trans_1m_m, 0.0, kExactTol) << "each metre is right in itself";
}

TEST(TrajectoryError, OfTwoPercentOfScaleIsTwoCentimetresPerMetre) {
  const Trajectory truth = make_trajectory(straight(40));
  const Trajectory estimate = make_trajectory(straight(40), [](int, const Pose2& p) {
    return Pose2{2.0 + 1.02 * (p.x - 2.0), p.y, p.yaw};
  });
  const TrajectoryError error = trajectory_error(estimate, {}, truth);
  EXPECT_NEAR(error.rpe_trans_1m_m, 0.02, kExactTol);
  EXPECT_NEAR(error.ate_max_m, 0.2, kExactTol);
}

TEST(TrajectoryError, OfHeadingThatDriftsAThirdOfADegreePerStepIsFourThirdsPerMetre) {
  const Trajectory truth = make_trajectory(straight(40));
  const Trajectory estimate = make_trajectory(straight(40), [](int i, const Pose2& p) {
    return Pose2{p.x, p.y, i * kDegree / 3.0};
  });
  EXPECT_NEAR(trajectory_error(estimate, {}, truth).rpe_rot_1m_deg, 4.0 / 3.0, kExactTol);
}

TEST(TrajectoryError, HeadingsOnBothSidesOfTheHalfTurnAreTwoDegreesApart) {
  const auto turned = [](double yaw) {
    return make_trajectory(straight(4), [yaw](int, const Pose2& p) { return Pose2{p.x, p.y, yaw}; });
  };
  EXPECT_NEAR(trajectory_error(turned(179.0 * kDegree), {}, turned(-179.0 * kDegree)).heading_rmse_deg, 2.0, kExactTol);
}

TEST(TrajectoryError, AWalkOfLessThanAMetreHasNoRelativeError) {
  const Trajectory walk = make_trajectory(straight(3));
  EXPECT_EQ(trajectory_error(walk, {}, walk).rpe_trans_1m_m, 0.0);
}

TEST(MatchPoses, InterpolatesTheTruthAndLeavesOutWhatLiesOutside) {
  const Trajectory truth = make_trajectory(straight(10));
  const Trajectory estimate = {{Time(-1ms), {}}, {Time(150ms), to_pose3({1.0, 0.0, 0.0})}, {Time(1001ms), {}}};
  const auto matches = pair_poses(estimate, {0.0, 0.0, std::numbers::pi / 2.0}, truth);
  ASSERT_EQ(matches.size(), 1U);
  EXPECT_THAT(matches[0].T_world_truth, Pose2Near((Pose2{2.375, 3.0, 0.0}), kExactTol, kExactTol));
  EXPECT_THAT(matches[0].T_world_estimate, Pose2Near((Pose2{0.0, 1.0, std::numbers::pi / 2.0}), kExactTol, kExactTol));
}

TEST(JoinAtStart, MakesTheFirstCommonInstantExactAndFitsNothingAfterwards) {
  const Trajectory truth = make_trajectory(corner());
  const Pose2 T_map_world{4.0, -1.0, 0.8};
  // The estimate begins a second later and drifts sideways by a millimetre a step.
  Trajectory estimate = make_trajectory(corner(), [&](int i, const Pose2& p) {
    return T_map_world * Pose2{p.x, p.y + 0.001 * (i - 10), p.yaw};
  });
  estimate.erase(estimate.begin(), estimate.begin() + 10);
  const Pose2 T_world_map = align_at_start(estimate, truth);
  EXPECT_THAT(T_world_map, Pose2Near(T_map_world.inverse(), kExactTol, kExactTol));
  EXPECT_NEAR(trajectory_error(estimate, T_world_map, truth).ate_max_m, 0.071, kExactTol);
}

TEST(TrajectoryError, WithoutACommonInstantIsRefused) {
  const Trajectory walk = make_trajectory(straight(4));
  const Trajectory later = {{Time(10s), {}}, {Time(11s), {}}};
  EXPECT_THROW(trajectory_error(later, {}, walk), InputError);
  EXPECT_THROW(align_at_start(later, walk), InputError);
  EXPECT_THROW(trajectory_error({}, {}, walk), InputError);
}

/// Poses every 0.1 s from one time to another.
Trajectory poses_between(double from_s, double to_s) {
  Trajectory trajectory;
  for (int i = 0; 0.1 * i <= to_s - from_s + 1e-9; ++i) trajectory.push_back({from_seconds(from_s + 0.1 * i), {}});
  return trajectory;
}

TEST(TimeCoverage, IsTheFractionOfTheReferencesTimeWithinAFifthOfASecondOfAPose) {
  const Trajectory reference = poses_between(0.0, 10.0);
  EXPECT_NEAR(time_coverage(reference, reference), 1.0, kExactTol);
  EXPECT_NEAR(time_coverage(poses_between(2.0, 6.0), reference), 0.44, kExactTol);
  EXPECT_NEAR(time_coverage(poses_between(5.0, 5.0), reference), 0.04, kExactTol);
  EXPECT_NEAR(time_coverage(poses_between(9.0, 20.0), reference), 0.12, kExactTol);
  EXPECT_NEAR(time_coverage(poses_between(-5.0, 0.1), reference), 0.03, kExactTol);
  EXPECT_EQ(time_coverage(poses_between(11.0, 12.0), reference), 0.0);
  EXPECT_EQ(time_coverage({}, reference), 0.0);
}

TEST(TimeCoverage, ASilenceOfThreeSecondsIsMissingButForTheFifthsAtItsEnds) {
  const Trajectory reference = poses_between(0.0, 10.0);
  Trajectory estimate = poses_between(0.0, 4.0);
  for (const StampedPose& pose : poses_between(7.0, 10.0)) estimate.push_back(pose);
  EXPECT_NEAR(time_coverage(estimate, reference), 1.0 - 0.26, kExactTol);
}

/// Moves every pose by a rigid motion in space.
Trajectory moved(const Trajectory& trajectory, const Pose3& T) {
  Trajectory result;
  for (const StampedPose& entry : trajectory) result.push_back({entry.stamp, T * entry.pose});
  return result;
}

TEST(AlignedError, OfARigidMotionIsZeroAndTheMotionIsFound) {
  const Trajectory truth = make_trajectory(corner());
  const Pose3 T_estimate_reference{{5.0, -3.0, 1.0}, quaternion_from_rpy(0.2, -0.3, 2.5)};
  const AlignedError error = aligned_error(moved(truth, T_estimate_reference), truth);
  EXPECT_EQ(error.num_pairs, 82U);
  EXPECT_NEAR(error.rmse_m, 0.0, kExactTol);
  EXPECT_NEAR(error.max_m, 0.0, kExactTol);
  EXPECT_THAT(error.T_reference_estimate, Pose3Near(T_estimate_reference.inverse(), 1e-9, 1e-7));
}

// Corners of a square pushed outwards by 1 cm: the centre and the heading stay, every corner errs by 1 cm. A
// fit of the scale would hide it.
TEST(AlignedError, DoesNotFitTheScale) {
  Trajectory square, larger;
  int i = 0;
  for (const Eigen::Vector2d& corner :
       {Eigen::Vector2d(1, 1), Eigen::Vector2d(-1, 1), Eigen::Vector2d(-1, -1), Eigen::Vector2d(1, -1)}) {
    const Time stamp = i++ * 1s;
    square.push_back({stamp, to_pose3({corner.x(), corner.y(), 0.0})});
    const Eigen::Vector2d out = corner * (1.0 + 0.01 / std::sqrt(2.0));
    larger.push_back({stamp, to_pose3({out.x(), out.y(), 0.0})});
  }
  const AlignedError error = aligned_error(larger, square);
  EXPECT_NEAR(error.rmse_m, 0.01, kExactTol);
  EXPECT_NEAR(error.mean_m, 0.01, kExactTol);
  EXPECT_NEAR(error.max_m, 0.01, kExactTol);
  EXPECT_THAT(error.T_reference_estimate, Pose3Near(Pose3{}, kExactTol, 1e-7));
}

// A square whose corners stand 1 cm up and down by turns, against its mirror image from below: only a
// reflection would lay one on the other; the best motion leaves every corner 2 cm off.
TEST(AlignedError, NeverTurnsAMirrorImageOver) {
  const Pose3 T_estimate_reference{{3.0, 1.0, -2.0}, quaternion_from_rpy(0.2, -0.3, 2.5)};
  Trajectory truth, mirrored;
  int i = 0;
  for (const Eigen::Vector2d& corner :
       {Eigen::Vector2d(1, 1), Eigen::Vector2d(-1, 1), Eigen::Vector2d(-1, -1), Eigen::Vector2d(1, -1)}) {
    const Time stamp = i * 1s;
    const double up_m = i++ % 2 == 0 ? 0.01 : -0.01;
    truth.push_back({stamp, {{corner.x(), corner.y(), up_m}, Eigen::Quaterniond::Identity()}});
    mirrored.push_back({stamp, {{corner.x(), corner.y(), -up_m}, Eigen::Quaterniond::Identity()}});
  }
  const AlignedError error = aligned_error(moved(mirrored, T_estimate_reference), truth);
  EXPECT_NEAR(error.rmse_m, 0.02, kExactTol);
  EXPECT_THAT(error.T_reference_estimate, Pose3Near(T_estimate_reference.inverse(), 1e-9, 1e-7));
}

TEST(AlignedError, PairsTheNearestStampWithinTenMilliseconds) {
  const Trajectory truth = make_trajectory(corner());
  Trajectory estimate;
  for (const StampedPose& entry : truth) estimate.push_back({entry.stamp + 10ms, entry.pose});
  EXPECT_EQ(aligned_error(estimate, truth).num_pairs, 82U);
  for (StampedPose& entry : estimate) entry.stamp += 1ms;
  EXPECT_THROW(aligned_error(estimate, truth), InputError);
}

TEST(AlignedError, PairsWithinTheGivenDifferenceOfStamps) {
  const Trajectory truth = make_trajectory(corner());
  Trajectory estimate;
  for (const StampedPose& entry : truth) estimate.push_back({entry.stamp + 40ms, entry.pose});
  EXPECT_EQ(aligned_error(estimate, truth, 50ms).num_pairs, 82U);
}

TEST(AlignedError, OfALevelLineIsThatOfTheBestMotionInThePlane) {
  const Trajectory line = make_trajectory(straight(20));
  const Pose3 T_estimate_reference = to_pose3({5.0, -3.0, 2.5});
  Trajectory estimate = moved(line, T_estimate_reference);
  EXPECT_THAT(aligned_error(estimate, line).T_reference_estimate,
              Pose3Near(T_estimate_reference.inverse(), 1e-9, 1e-9));
  const Trajectory longer = make_trajectory(straight(20), [](int, const Pose2& p) {
    return Pose2{1.1 * p.x, p.y, p.yaw};
  });
  EXPECT_NEAR(aligned_error(moved(longer, T_estimate_reference), line).max_m, 0.25, kExactTol) << "half of 10 % of 5 m";
}

TEST(AlignedError, OfAPointASlopingLineOrTwoPosesIsRefused) {
  const Trajectory line = make_trajectory(straight(20)), two = make_trajectory(straight(1));
  const Trajectory still = make_trajectory(std::vector<Pose2>(20, Pose2{1.0, 2.0, 0.0}));
  const Trajectory sloping = moved(line, {{}, quaternion_from_rpy(0.0, 0.1, 0.0)});
  EXPECT_THROW(aligned_error(still, still), InputError);
  EXPECT_THROW(aligned_error(still, line), InputError);
  EXPECT_THROW(aligned_error(sloping, sloping), InputError);
  EXPECT_THROW(aligned_error(two, two), InputError);
  EXPECT_THROW(aligned_error({}, line), InputError);
}

/// The corner without the poses from 3 s to 5 s, both not included: 2 m before and 3 m after the turn at 4 s.
Trajectory with_hole(Trajectory trajectory) {
  std::erase_if(trajectory, [](const StampedPose& entry) { return entry.stamp > 3s && entry.stamp < 5s; });
  return trajectory;
}

TEST(MatchPoses, LeavesOutPosesInHolesOfTheTruth) {
  const Trajectory truth = make_trajectory(corner());
  const auto matches = pair_poses(truth, {}, with_hole(truth));
  EXPECT_EQ(matches.size(), 82U - 19U);
  const TrajectoryError error = trajectory_error(truth, {}, with_hole(truth));
  EXPECT_EQ(error.num_poses, 82U - 19U);
  EXPECT_NEAR(error.ate_max_m, 0.0, kExactTol);
}

// The estimate jumps by 5 m in the hole.
TEST(TrajectoryError, HasNoSegmentAcrossAHoleOfTheTruth) {
  const Trajectory truth = make_trajectory(straight(40));
  Trajectory jumped = truth;
  for (StampedPose& entry : jumped)
    if (entry.stamp >= 3s) entry.pose.position.x() += 5.0;
  Trajectory holed = truth;
  std::erase_if(holed, [](const StampedPose& entry) { return entry.stamp > 1s && entry.stamp < 3s; });
  EXPECT_NEAR(trajectory_error(jumped, {}, holed).rpe_trans_1m_m, 0.0, kExactTol);
}

TEST(JoinAtStart, SkipsAHoleOfTheTruth) {
  const Trajectory truth = make_trajectory(corner());
  Trajectory estimate = truth;
  estimate.erase(estimate.begin(), estimate.begin() + 35);
  EXPECT_THAT(align_at_start(estimate, with_hole(truth)), Pose2Near(Pose2{}, kExactTol, kExactTol));
}

}  // namespace
}  // namespace patrol::score::trajectory_error_test
