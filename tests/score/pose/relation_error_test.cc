#include "score/pose/relation_error.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/angles.h"

namespace patrol::score::relation_error_test {
namespace {

using namespace std::chrono_literals;

constexpr double kTol = 1e-12;

StampedPose pose_at(Time stamp, double x, double y = 0.0, double yaw = 0.0) {
  return {stamp, to_pose3(Pose2{x, y, yaw})};
}

/// Along x at 1 m/s, once a second.
Trajectory straight() {
  Trajectory trajectory;
  for (int i = 0; i < 10; ++i) trajectory.push_back(pose_at(i * 1s, i));
  return trajectory;
}

TEST(RelationError, IsNoneWhereTheTrajectoryKeepsTheRelation) {
  const RelationError error =
      relation_error({pose_at(1s, 5.0, 5.0, std::numbers::pi / 2.0), pose_at(2s, 4.0, 7.0, std::numbers::pi)},
                     {{1s, 2s, {2.0, 1.0, std::numbers::pi / 2.0}}});
  EXPECT_NEAR(error.trans_m.mean, 0.0, kTol);
  EXPECT_NEAR(error.rot_deg.mean, 0.0, 1e-10);
  EXPECT_EQ(error.num_relations, 1U);
  EXPECT_EQ(error.num_stamps, 2U);
  EXPECT_EQ(error.num_interpolated, 0U);
}

TEST(RelationError, DoesNotChangeWhenTheWholeTrajectoryIsMoved) {
  const std::vector<PoseRelation> relations = {{0s, 3s, {2.0, 0.5, 0.1}}, {2s, 7s, {5.5, -0.5, -0.2}}};
  const Pose2 T_new_old{100.0, -50.0, 2.0};
  Trajectory moved = straight();
  for (StampedPose& entry : moved) entry.pose = to_pose3(T_new_old * to_pose2(entry.pose));
  EXPECT_NEAR(relation_error(moved, relations).trans_m.mean, relation_error(straight(), relations).trans_m.mean, kTol);
  EXPECT_NEAR(relation_error(moved, relations).rot_deg.mean, relation_error(straight(), relations).rot_deg.mean, 1e-10);
}

TEST(RelationError, MeanAndDeviationOfErrorsAndTheirSquaresAreThoseOfTheList) {
  // Errors 1, 2 and 6 m: mean 3, variance (4 + 1 + 9) / 3; squares 1, 4, 36: mean 41/3.
  const RelationError error =
      relation_error(straight(), {{0s, 1s, {2.0, 0.0, 0.0}}, {0s, 1s, {1.0, 2.0, 0.0}}, {0s, 1s, {1.0, -6.0, 0.0}}});
  EXPECT_NEAR(error.trans_m.mean, 3.0, kTol);
  EXPECT_NEAR(error.trans_m.std, std::sqrt(14.0 / 3.0), kTol);
  EXPECT_NEAR(error.squared_trans_m2.mean, 41.0 / 3.0, kTol);
  EXPECT_NEAR(error.squared_trans_m2.std, std::sqrt((38.0 * 38.0 + 29.0 * 29.0 + 67.0 * 67.0) / 27.0), 1e-10)
      << "thirds of a metre: -38, -29, 67";
  EXPECT_NEAR(error.trans_median_m, 2.0, kTol);
  EXPECT_NEAR(error.trans_max_m, 6.0, kTol);
}

TEST(RelationError, TheMedianOfAnEvenNumberIsTheUpperOne) {
  const RelationError error = relation_error(straight(), {{0s, 1s, {1.0, 1.0, 0.0}}, {0s, 1s, {1.0, 4.0, 0.0}}});
  EXPECT_NEAR(error.trans_median_m, 4.0, kTol);
}

TEST(RelationError, HeadingsAreComparedTheShortWayInDegrees) {
  const Trajectory turned = {pose_at(0s, 0.0, 0.0, 3.0), pose_at(1s, 0.0, 0.0, -3.0)};
  const double turn = 2.0 * std::numbers::pi - 6.0;
  const RelationError error =
      relation_error(turned, {{0s, 1s, {0.0, 0.0, turn + 0.1}}, {0s, 1s, {0.0, 0.0, turn - 0.3}}});
  EXPECT_NEAR(error.rot_deg.mean, 0.2 * kDegPerRad, 1e-10);
  EXPECT_NEAR(error.rot_deg.std, 0.1 * kDegPerRad, 1e-10);
  EXPECT_NEAR(error.rot_max_deg, 0.3 * kDegPerRad, 1e-10);
  EXPECT_NEAR(error.rot_median_deg, 0.3 * kDegPerRad, 1e-10);
  EXPECT_NEAR(error.squared_rot_deg2.mean, (0.01 + 0.09) / 2.0 * kDegPerRad * kDegPerRad, 1e-9);
}

TEST(RelationError, APoseWithinMaxDtIsTakenAsItIs) {
  const RelationSettings settings{.max_dt_s = 0.1};
  const RelationError error = relation_error(straight(), {{100ms, 2900ms, {3.0, 0.0, 0.0}}}, settings);
  EXPECT_NEAR(error.trans_m.mean, 0.0, kTol) << "at 0 s and 3 s";
  EXPECT_EQ(error.num_interpolated, 0U);
}

TEST(RelationError, FurtherOffItIsInterpolatedAndCountedOnceAStamp) {
  const RelationSettings settings{.max_dt_s = 0.1};
  const RelationError error =
      relation_error(straight(), {{250ms, 3s, {2.75, 0.0, 0.0}}, {250ms, 4s, {3.75, 0.0, 0.0}}}, settings);
  EXPECT_NEAR(error.trans_max_m, 0.0, kTol);
  EXPECT_EQ(error.num_stamps, 3U);
  EXPECT_EQ(error.num_interpolated, 1U);
  EXPECT_EQ(error.num_outside, 0U);
}

TEST(RelationError, HeadingsAreInterpolatedTheShortWay) {
  const Trajectory turned = {pose_at(0s, 0.0, 0.0, 3.0), pose_at(1s, 0.0, 0.0, -3.0)};
  const double turn = 2.0 * std::numbers::pi - 6.0;
  EXPECT_NEAR(relation_error(turned, {{0s, 500ms, {0.0, 0.0, turn / 2.0}}}).rot_deg.mean, 0.0, 1e-10);
}

TEST(RelationError, OfAStampOutsideTheTrajectoryIsLeftOutAndCounted) {
  const RelationError error =
      relation_error(straight(), {{Time(-5s), 2s, {9.0, 0.0, 0.0}}, {1s, 3s, {2.0, 0.0, 0.0}}, {8s, 20s, {}}});
  EXPECT_NEAR(error.trans_max_m, 0.0, kTol);
  EXPECT_EQ(error.num_relations, 1U);
  EXPECT_EQ(error.num_given, 3U);
  EXPECT_EQ(error.num_outside, 2U);
  EXPECT_EQ(error.num_interpolated, 0U);
}

TEST(RelationError, WithinMaxDtOfTheEndsOfTheTrajectoryIsScored) {
  const RelationError error = relation_error(straight(), {{Time(-10ms), 9010ms, {9.0, 0.0, 0.0}}});
  EXPECT_EQ(error.num_relations, 1U);
  EXPECT_EQ(error.num_outside, 0U);
}

TEST(RelationError, OfAStampInAHoleOfTheTrajectoryIsLeftOutAndCounted) {
  Trajectory with_hole = straight();
  with_hole.erase(with_hole.begin() + 3, with_hole.begin() + 7);  // 5 s of steps of 1 s
  const RelationError error = relation_error(with_hole, {{0s, 4s, {9.0, 0.0, 0.0}}, {1s, 7s, {6.0, 0.0, 0.0}}});
  EXPECT_NEAR(error.trans_max_m, 0.0, kTol);
  EXPECT_EQ(error.num_relations, 1U);
  EXPECT_EQ(error.num_in_holes, 1U);
}

TEST(RelationError, NoRelationInTheTimeOfTheTrajectoryIsRefused) {
  EXPECT_THROW(relation_error(straight(), {{100s, 102s, {2.0, 0.0, 0.0}}}), InputError);
}

TEST(RelationError, TheReferencePointMayLieAheadOfTheBody) {
  // Turning by 90 deg on the spot moves a point 1 m ahead from (1, 0) to (0, 1): seen from the first (-1, 1).
  const Trajectory turned = {pose_at(0s, 0.0, 0.0, 0.0), pose_at(1s, 0.0, 0.0, std::numbers::pi / 2.0)};
  const std::vector<PoseRelation> relations = {{0s, 1s, {-1.0, 1.0, std::numbers::pi / 2.0}}};
  EXPECT_NEAR(relation_error(turned, relations, {.reference_x_m = 1.0}).trans_m.mean, 0.0, kTol);
  EXPECT_NEAR(relation_error(turned, relations).trans_m.mean, std::sqrt(2.0), kTol);
}

TEST(RelationError, StampsSinceNineteenSeventyDoNotLoseTheirMicroseconds) {
  // A microsecond at 1000 km/s is a metre: doubles of such stamps would be good to 0.1 m only.
  const Time start(976'052'857'000'000'000);
  const Trajectory fast = {pose_at(start, 0.0), pose_at(start + 1s, 1e6)};
  const RelationError error =
      relation_error(fast, {{start + 300'000us, start + 300'001us, {1.0, 0.0, 0.0}}}, {.max_dt_s = 0.0});
  EXPECT_NEAR(error.trans_m.mean, 0.0, 1e-9);
}

TEST(RelationError, NothingToScoreIsRefused) {
  EXPECT_THROW(relation_error({}, {{0s, 1s, {}}}), InputError);
  EXPECT_THROW(relation_error(straight(), {}), InputError);
  EXPECT_THROW(relation_error(straight(), {{0s, 1s, {}}}, {.max_dt_s = -1.0}), InputError);
}

}  // namespace
}  // namespace patrol::score::relation_error_test
