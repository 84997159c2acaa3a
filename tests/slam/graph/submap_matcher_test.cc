#include "slam/graph/submap_matcher.h"

#include <gtest/gtest.h>

#include "tests/slam/graph/office_world.h"
#include "tests/slam/graph/rendered_submap.h"
#include "tests/support/pose_near.h"

namespace patrol::slam::submap_matcher_test {
namespace {

using test::Pose2Near, test::drive_past;

PoseGaussian around(const Pose2& mean, double std_m, double std_rad) {
  return {.mean = mean, .covariance = Eigen::Vector3d(std_m * std_m, std_m * std_m, std_rad * std_rad).asDiagonal()};
}

const Pose2 kThere{8.0, 4.2, 0.0};               ///< where the first way begins, looking along x
const Pose2 kBack{17.0, 4.3, std::numbers::pi};  ///< the second comes back
const Pose2 kTruth = kThere.inverse() * kBack;

TEST(MatchSubmaps, MatchesAPathAndItsReturnToTwoCentimetersFromAMeterAndElevenDegreesOff) {
  const test::RoomWorld office = test::make_office();
  const RenderedSubmap target = drive_past(office, {{8.0, 4.2}, {16.0, 4.2}}, 1),
                       source = drive_past(office, {{17.0, 4.3}, {9.0, 4.1}}, 2);
  const Pose2 off{kTruth.x + 0.8, kTruth.y - 0.6,
                  kTruth.yaw + 0.2 - 0.025};  // the second way bears 0.025 rad to the left
  const SubmapMatchResult result = match_submaps(target, source, around(off, 0.7, 0.1), {}, {});
  ASSERT_TRUE(result.match);
  const Pose2 truth = kThere.inverse() * Pose2{17.0, 4.3, std::atan2(-0.2, -8.0)};
  EXPECT_THAT(result.match->T_target_source, Pose2Near(truth, 0.02, 0.003));
  EXPECT_GT(result.match->inlier_ratio, 0.85);
}

TEST(MatchSubmaps, OppositeSidesOfTheBuildingAreNotMatchedForAnyPrediction) {
  const test::RoomWorld office = test::make_office();
  const RenderedSubmap target = drive_past(office, {{8.0, 4.2}, {16.0, 4.2}}, 1),
                       source = drive_past(office, {{32.0, 25.8}, {24.0, 25.8}}, 2);
  for (const double yaw : {0.0, 1.5, 3.0, -1.5}) {
    EXPECT_FALSE(match_submaps(target, source, around({3.0, 0.0, yaw}, 2.0, 0.2), {}, {}).match) << yaw;
  }
}

TEST(LocateSubmap, FindsAPartOfTheBuildingAtAnyAngleInTheMapOfTheWholeToTwoCentimeters) {
  const test::RoomWorld office = test::make_office();
  const RenderedSubmap map = drive_past(office, test::office_rounds(1), 1),
                       source = drive_past(office, {{32.0, 25.7}, {24.0, 25.7}}, 2);
  const SearchWindow window{
      .T_map_center = {14.0, 10.8, 0.0}, .half_width_m = 25.0, .half_angle_rad = std::numbers::pi};
  const SubmapMatchResult result = locate_submap(map, source, window, {}, {});
  ASSERT_TRUE(result.match);
  const Pose2 truth = Pose2{8.0, 4.2, 0.0}.inverse() * Pose2{32.0, 25.7, std::numbers::pi};
  EXPECT_THAT(result.match->T_target_source, Pose2Near(truth, 0.02, 0.003));
  EXPECT_GT(result.match->inlier_ratio, 0.85);
}

// Doors every 3 m, all alike: with a meter of doubt only one place fits, with three meters there are several, and none
// is taken.
TEST(MatchSubmaps, AmongIdenticalDoorsAMatchIsTakenOnlyWhereNoOtherCanBeMeant) {
  const test::RoomWorld corridor = test::make_corridor_of_doors();
  const RenderedSubmap target = drive_past(corridor, {{22.0, 0.0}, {30.0, 0.0}}, 1),
                       source = drive_past(corridor, {{23.0, 0.1}, {31.0, 0.1}}, 2);
  const SubmapMatchResult sure = match_submaps(target, source, around({1.2, 0.0, 0.0}, 0.3, 0.02), {}, {});
  ASSERT_TRUE(sure.match);
  EXPECT_THAT(sure.match->T_target_source, Pose2Near(Pose2{1.0, 0.1, 0.0}, 0.03, 0.003));
  const SubmapMatchResult unsure = match_submaps(target, source, around({1.2, 0.0, 0.0}, 2.0, 0.02), {}, {});
  EXPECT_FALSE(unsure.match);
  EXPECT_EQ(unsure.failure, MatchFailure::kAmbiguous);
}

}  // namespace
}  // namespace patrol::slam::submap_matcher_test
