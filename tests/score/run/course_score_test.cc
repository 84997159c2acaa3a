#include "score/run/course_score.h"

#include <gtest/gtest.h>

namespace patrol::score::course_score_test {
namespace {

/// Run along x at 1 m/s from 5 s on, to 20 m; the goal is at 10 m.
RunRecord drive() {
  RunRecord record;
  for (int i = 0; i <= 2500; ++i) {
    const double t = 0.01 * i;
    record.T_world_body.push_back({from_seconds(t), to_pose3(Pose2{std::max(0.0, t - 5.0), 0.0, 0.0})});
  }
  return record;
}

constexpr double kArrival_m = 1.0;
const Eigen::Vector2d kGoal(10.0, 0.0);

TEST(CourseScore, TheTimeRunsFromTheFirst10CentimetersToOneMeterBeforeTheGoal) {
  const CourseScore score = course_score(drive(), kGoal, kArrival_m, 4.0);
  EXPECT_TRUE(score.is_successful);
  ASSERT_TRUE(score.duration_s);
  EXPECT_NEAR(*score.duration_s, 8.9, 0.011);
  EXPECT_NEAR(score.score, 4.0 / 8.9, 1e-3);
}

TEST(CourseScore, IsAtMostOneHalfAndAtLeastOneEighthForASuccess) {
  EXPECT_EQ(course_score(drive(), kGoal, kArrival_m, 100.0).score, 0.5);
  EXPECT_EQ(course_score(drive(), kGoal, kArrival_m, 0.1).score, 0.125);
}

TEST(CourseScore, ACollisionBeforeTheArrivalIsAFailureAndOneAfterItIsNot) {
  RunRecord record = drive();
  record.collisions.push_back({.stamp = from_seconds(20.0), .first = "hull", .second = "wall"});
  EXPECT_TRUE(course_score(record, kGoal, kArrival_m, 4.0).is_successful);
  record.collisions.push_back({.stamp = from_seconds(8.0), .first = "hull", .second = "cylinder"});
  const CourseScore score = course_score(record, kGoal, kArrival_m, 4.0);
  EXPECT_TRUE(score.has_collided);
  EXPECT_FALSE(score.is_successful);
  EXPECT_EQ(score.score, 0.0);
  EXPECT_TRUE(score.duration_s);
}

TEST(CourseScore, WithoutAnArrivalThereIsNoTimeAndNoScore) {
  const CourseScore score = course_score(drive(), {10.0, 5.0}, kArrival_m, 4.0);
  EXPECT_FALSE(score.is_successful);
  EXPECT_FALSE(score.has_collided);
  EXPECT_FALSE(score.duration_s);
  EXPECT_EQ(score.score, 0.0);
}

}  // namespace
}  // namespace patrol::score::course_score_test
