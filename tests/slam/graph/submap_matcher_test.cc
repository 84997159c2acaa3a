#include "slam/graph/submap_matcher.h"

#include <gtest/gtest.h>

#include "tests/slam/graph/door_gallery.h"
#include "tests/slam/graph/office_world.h"
#include "tests/slam/graph/rendered_submap.h"
#include "tests/support/pose_near.h"

namespace patrol::slam::submap_matcher_test {
namespace {

using test::Pose2Near, test::drive_past;

PoseGaussian around(const Pose2& mean, double std_m, double std_rad) {
  return {.mean = mean, .covariance = Eigen::Vector3d(std_m * std_m, std_m * std_m, std_rad * std_rad).asDiagonal()};
}

const Pose2 kThere{8.0, 4.2, 0.0};               ///< start of the first path, which runs along x
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

/// A corridor with a door every 3 m and no end in reach, along 10 to 26 m and back along 20 to 4 m.
struct PassagesOfDoors {
  static constexpr double kSpacing_m = 3.0;

  explicit PassagesOfDoors(double phase_m)
      : corridor(test::make_endless_corridor_of_doors(kSpacing_m, phase_m)),
        target(drive_past(corridor, {{10.0, 0.2}, {26.0, 0.2}}, 1, test::DoorGallery::kLidar)),
        source(drive_past(corridor, {{20.0, -0.2}, {4.0, -0.2}}, 2, test::DoorGallery::kLidar)) {}

  test::RoomWorld corridor;
  RenderedSubmap target, source;
  Pose2 truth{10.0, -0.4, std::numbers::pi};
};

TEST(MatchSubmaps, APoseOffByADoorHasTheHighestScoreAndIsRejectedForItsInlierRatio) {
  SubmapMatcherSettings score_only;
  score_only.max_second_best_inlier_fraction = 10.0;
  for (const double phase_m : {0.0, 1.0, 2.0}) {
    const PassagesOfDoors doors(phase_m);
    const PoseGaussian prediction = around(doors.truth, 1.1, 0.02);
    const SubmapMatchResult by_score = match_submaps(doors.target, doors.source, prediction, score_only, {});
    ASSERT_TRUE(by_score.match) << phase_m;
    EXPECT_NEAR(by_score.match->T_target_source.x - doors.truth.x, doors.kSpacing_m, 0.05) << phase_m;
    EXPECT_EQ(match_submaps(doors.target, doors.source, prediction, {}, {}).failure, MatchFailure::kAmbiguous);
  }
}

TEST(MatchSubmapsByTracking, TakesTheDoorThatTheTrackedPoseMeansIfNoOtherIsWithinSixStandardDeviations) {
  const PassagesOfDoors doors(0.5);
  const auto match = [&](double off_m, double std_m) {
    const Pose2 tracked{doors.truth.x + off_m, doors.truth.y, doors.truth.yaw};
    return match_submaps_by_tracking(doors.target, doors.source, around(tracked, std_m, 0.02), {}, {});
  };
  for (const double off_m : {-0.5, 0.0, 0.5}) {
    const SubmapMatchResult sure = match(off_m, 0.3);
    ASSERT_TRUE(sure.match) << off_m;
    EXPECT_THAT(sure.match->T_target_source, Pose2Near(doors.truth, 0.03, 0.003)) << off_m;
  }
  for (const auto& [off_m, std_m] : {std::pair{0.0, 0.6}, {1.2, 0.3}, {-1.2, 0.3}, {1.5, 0.6}}) {
    const SubmapMatchResult unsure = match(off_m, std_m);
    EXPECT_FALSE(unsure.match) << off_m << " " << std_m;
    EXPECT_EQ(unsure.failure, MatchFailure::kAmbiguous);
  }
}

TEST(MatchSubmapsByTracking, RejectsEveryMatchIfThePossiblePosesReachBeyondTheLargestSearch) {
  const PassagesOfDoors doors(0.5);
  SubmapMatcherSettings narrow;
  narrow.max_window_m = 1.5;
  EXPECT_FALSE(match_submaps_by_tracking(doors.target, doors.source, around(doors.truth, 0.3, 0.02), narrow, {}).match);
  narrow.max_window_m = 3.0;
  EXPECT_TRUE(match_submaps_by_tracking(doors.target, doors.source, around(doors.truth, 0.3, 0.02), narrow, {}).match);
}

// The only door of 16 m of wall is a small part of the surfaces: a pose half a meter off agrees almost as well.
TEST(MatchSubmapsByTracking, RejectsAMatchOfBareWallsThatCanSlide) {
  test::RoomWorld corridor;
  for (const double side : {-1.2, 1.2})
    corridor.add_polyline(test::wall_with_doors(side, -100.0, 100.0, side < 0.0 ? 14.0 : 100.0, 300.0));
  const RenderedSubmap target = drive_past(corridor, {{10.0, 0.2}, {26.0, 0.2}}, 1, test::DoorGallery::kLidar),
                       source = drive_past(corridor, {{20.0, -0.2}, {4.0, -0.2}}, 2, test::DoorGallery::kLidar);
  const Pose2 truth{10.0, -0.4, std::numbers::pi};
  const SubmapMatchResult result = match_submaps_by_tracking(target, source, around(truth, 0.1, 0.02), {}, {});
  EXPECT_FALSE(result.match);
  EXPECT_EQ(result.failure, MatchFailure::kAmbiguous);
  SubmapMatcherSettings any_ratio;  // accepts the ratio of a shifted pose that is below that of the match
  any_ratio.max_second_best_inlier_fraction = 10.0;
  EXPECT_TRUE(match_submaps_by_tracking(target, source, around(truth, 0.1, 0.02), any_ratio, {}).match);
}

}  // namespace
}  // namespace patrol::slam::submap_matcher_test
