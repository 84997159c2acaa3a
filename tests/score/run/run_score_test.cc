#include "score/run/run_score.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/geometry/angles.h"

namespace patrol::score::run_score_test {
namespace {

using namespace std::chrono_literals;

/// A wall along y = 3 m.
OccupancyGrid wall_map() {
  OccupancyGrid map(GridGeometry{.resolution_m = 0.1, .width = 60, .height = 60, .origin_m = {-1.0, -2.0}}, kFree);
  for (int col = 0; col < 60; ++col) map.at({col, 50}) = kOccupied;
  return map;
}

/// Two meters along x and two along y in four seconds, estimated without error.
RunRecord perfect_run() {
  RunRecord record;
  for (int i = 0; i <= 40; ++i) {
    const Pose2 T_world_body{0.1 * std::min(i, 20), 0.1 * std::max(i - 20, 0), 0.0};
    const StampedPose pose{.stamp = from_seconds(0.1 * i), .pose = to_pose3(T_world_body)};
    record.T_world_body.push_back(pose);
    record.T_map_body.push_back(pose);
    record.T_odom_body.push_back(pose);
    record.T_map_body_received.push_back(pose.stamp);
    record.T_odom_body_received.push_back(pose.stamp);
    record.covariances.push_back(Eigen::Matrix3d::Identity());
  }
  record.map = wall_map();
  return record;
}

RunReferences wall_references() {
  RunReferences references;
  references.map = {.cells = wall_map(), .is_observable = Grid<std::uint8_t>(wall_map().geometry(), 1)};
  references.localizability = [](const Eigen::Vector2d&) { return Localizability{}; };
  return references;
}

Event event_of(EventKind kind, Time stamp, const std::string& subject = "") {
  return {.stamp = stamp, .kind = kind, .subject = subject, .T_map_body = {}};
}

TEST(MissionScore, CountsEventsByTheirKind) {
  RunRecord record = perfect_run();
  record.events = {event_of(EventKind::kSensorFault, 1s, "imu"), event_of(EventKind::kSensorFault, 2s, "lidar"),
                   event_of(EventKind::kSensorRecovered, 3s, "imu"), event_of(EventKind::kMissionCompleted, 4s)};
  record.collisions.resize(2);
  const MissionScore score = mission_score(record, {});
  EXPECT_TRUE(score.is_completed);
  EXPECT_FALSE(score.has_fallen);
  EXPECT_EQ(score.num_sensor_faults, 2U);
  EXPECT_EQ(score.num_collisions, 2U);
  EXPECT_NEAR(score.duration_s, 4.0, 1e-9);
  EXPECT_NEAR(score.distance_m, 4.0, 1e-6);
}

TEST(MissionScore, AFallReportOfTheFirmwareIsAFallWithoutAnEventOfTheStack) {
  RunRecord record = perfect_run();
  record.has_fall_report = true;
  EXPECT_TRUE(mission_score(record, {}).has_fallen);
}

/// Stations at the corner and at the end of perfect_run.
std::vector<MissionGoal> two_stations() {
  return {{.name = "corner", .p_world_m = {2.0, 0.0}, .accuracy_m = 0.2, .is_required = true},
          {.name = "end", .p_world_m = {2.0, 2.0}, .accuracy_m = 0.2, .is_required = true}};
}

TEST(MissionScore, AMissionIsCompletedByTheReportAndATrueArrivalAtEachStation) {
  RunRecord record = perfect_run();
  record.events = {event_of(EventKind::kStationReached, 2s, "corner"), event_of(EventKind::kStationReached, 4s, "end"),
                   event_of(EventKind::kMissionCompleted, 4s)};
  EXPECT_TRUE(mission_score(record, two_stations()).is_completed);
  EXPECT_EQ(mission_score(record, two_stations()).num_false_arrivals, 0U);
  record.events.pop_back();
  EXPECT_FALSE(mission_score(record, two_stations()).is_completed) << "not reported";
  EXPECT_FALSE(mission_score(record, two_stations()).is_reported_completed);
}

TEST(MissionScore, AReportedArrivalFarFromTheStationIsFalseAndTheMissionNotCompleted) {
  RunRecord record = perfect_run();
  record.events = {event_of(EventKind::kStationReached, 2s, "corner"), event_of(EventKind::kStationReached, 2s, "end"),
                   event_of(EventKind::kMissionCompleted, 4s)};
  const MissionScore score = mission_score(record, two_stations());
  EXPECT_FALSE(score.is_completed);
  EXPECT_TRUE(score.is_reported_completed);
  EXPECT_EQ(score.num_false_arrivals, 1U);
}

TEST(MissionScore, AMissionWhoseStationsTheRobotNeverReportedIsNotCompleted) {
  RunRecord record = perfect_run();
  record.events = {event_of(EventKind::kMissionCompleted, 0s)};
  EXPECT_FALSE(mission_score(record, two_stations()).is_completed);
  EXPECT_EQ(mission_score(record, two_stations()).num_false_arrivals, 0U);
}

TEST(RunRecord, HasAnEstimateWithThreePoses) {
  RunRecord record = perfect_run();
  record.map = {};
  record.T_odom_body.clear();
  record.T_map_body.resize(3);
  EXPECT_TRUE(record.has_estimate());
  EXPECT_FALSE(record.has_map());
  record.T_map_body.resize(2);
  EXPECT_FALSE(record.has_estimate());
}

TEST(EstimateScore, OfAStackThatPublishesOnlyPosesHasNoOdometryAndNoMap) {
  RunRecord record = perfect_run();
  record.map = {};
  record.T_odom_body.clear();
  record.T_odom_body_received.clear();
  const EstimateScore score = estimate_score(record, wall_references());
  EXPECT_NEAR(score.pose.ate_rmse_m, 0.0, 1e-9);  // poses come at the common clock
  EXPECT_NEAR(score.T_world_map.x, 0.0, 1e-9);
  EXPECT_FALSE(score.odometry || score.map);
}

TEST(EstimateScore, OfAMapWithoutCellsHasACoverageOfZero) {
  RunRecord record = perfect_run();
  record.map = {};
  record.has_empty_map = true;
  const EstimateScore score = estimate_score(record, wall_references());
  EXPECT_EQ(score.map.value().coverage, 0.0);
  EXPECT_EQ(score.map.value().num_occupied, 0U);
}

TEST(EstimateScore, OfAPerfectRunHasNoErrorAndOnlyThePartsThatTheLogHas) {
  RunRecord record = perfect_run();
  record.events = {event_of(EventKind::kReplan, 1s), event_of(EventKind::kRecovery, 2s),
                   event_of(EventKind::kRecovery, 3s)};
  const EstimateScore score = estimate_score(record, wall_references());
  EXPECT_NEAR(score.pose.ate_rmse_m, 0.0, 1e-9);
  EXPECT_NEAR(score.odometry.value().ate_rmse_m, 0.0, 1e-9);
  EXPECT_NEAR(score.pose_coverage, 1.0, 1e-9);
  EXPECT_EQ(score.nees.num_instants, 41U);
  EXPECT_NEAR(score.nees.mean, 0.0, 1e-9);
  EXPECT_NEAR(score.map.value().nearest_mean_m, 0.0, 1e-9);
  EXPECT_EQ(score.navigation.num_detours, 1U);
  EXPECT_EQ(score.navigation.num_recoveries, 2U);
  EXPECT_EQ(score.localizability.size(), 9U) << "two a second";
  EXPECT_FALSE(score.docking || score.range_pose || score.known_map || score.lining || score.water);
  EXPECT_TRUE(score.goals.empty());
}

// Estimates end at 2.5 s, odometry goes on with 1 % of scale error: at the end 1 % of the 1.5 m from (2, 0.5) to (2,
// 2).
TEST(EstimateScore, ScoresASilentEstimatorByItsLastCorrectionAndOdometryToTheEnd) {
  RunRecord record = perfect_run();
  for (StampedPose& pose : record.T_odom_body) pose.pose.position *= 1.01;
  record.T_map_body.resize(26);
  record.T_map_body_received.resize(26);
  record.covariances.resize(26);
  const EstimateScore score = estimate_score(record, wall_references());
  EXPECT_EQ(score.pose.num_poses, 41U);
  EXPECT_NEAR(score.pose.ate_max_m, 0.015, 1e-9);
  EXPECT_NEAR(score.pose_coverage, 2.7 / 4.0, 1e-9);
  EXPECT_EQ(score.nees.num_instants, 26U);
}

TEST(EstimateScore, ScoresTheLocalizationOverItsSilence) {
  RunRecord record = perfect_run();
  record.confidences = {{.stamp = 0s, .confidence = 0.9}};
  record.T_map_body.resize(26);
  record.T_map_body_received.resize(26);
  record.T_odom_body.resize(26);
  record.T_odom_body_received.resize(26);
  const EstimateScore score = estimate_score(record, wall_references());
  ASSERT_TRUE(score.known_map);
  EXPECT_NEAR(score.known_map->localization.max_error_m, 1.5, 1e-9) << "held at (2, 0.5), truth at (2, 2)";
  EXPECT_NEAR(*score.known_map->localization.error_exceeded_at_s, 3.05, 0.06);
}

TEST(EstimateScore, OfAnEmptyMapCoversNothingAndHasNoDistances) {
  RunRecord record = perfect_run();
  record.map = OccupancyGrid(record.map.geometry(), kFree);
  const MapError error = estimate_score(record, wall_references()).map.value();
  EXPECT_EQ(error.num_occupied, 0U);
  EXPECT_EQ(error.coverage, 0.0);
  EXPECT_EQ(error.iou, 0.0);
  EXPECT_EQ(error.cells_m.values().size(), record.map.values().size());
}

TEST(EstimateScore, WhereTheRobotSeesNoSurfaceHasNoErrorOfTheMap) {
  RunReferences references = wall_references();
  references.map.is_observable = Grid<std::uint8_t>(wall_map().geometry(), 0);
  EXPECT_FALSE(estimate_score(perfect_run(), references).map.has_value());
  EXPECT_NEAR(estimate_score(perfect_run(), references).pose.ate_rmse_m, 0.0, 1e-9);
  references.map.cells = OccupancyGrid(wall_map().geometry(), kFree);
  EXPECT_FALSE(estimate_score(perfect_run(), references).map.has_value());
}

TEST(EstimateScore, OfAnEstimateThatNeverMovesHasEveryErrorButTheFittedOne) {
  RunRecord record = perfect_run();
  for (StampedPose& pose : record.T_map_body) pose.pose = {};
  const EstimateScore score = estimate_score(record, wall_references());
  EXPECT_FALSE(score.aligned_pose);
  EXPECT_NEAR(score.pose.ate_max_m, std::sqrt(8.0), 1e-9);
}

// A lidar with a mounting yaw turns map and path against the body. The map itself is straight; the pose that is aligned
// at the start is not.
TEST(EstimateScore, PlacesAMapOfTheRunWhereItFitsTheSurfaces) {
  RunRecord record = perfect_run();
  std::fill(record.map.values().begin(), record.map.values().end(), kFree);
  for (int col = 5; col < 55; ++col) {
    const Eigen::Vector2d p_world = record.map.geometry().center_of({col, 50});
    record.map.at(record.map.geometry().cell_at(Pose2{0.0, 0.0, to_rad(-3.0)} * p_world)) = kOccupied;
  }
  for (StampedPose& pose : record.T_map_body) {
    pose.pose.position = 3.0 * (quaternion_from_yaw(to_rad(-3.0)) * pose.pose.position);
  }
  for (StampedPose& pose : record.T_world_body) pose.pose.position *= 3.0;
  for (StampedPose& pose : record.T_odom_body) pose.pose.position *= 3.0;
  const EstimateScore score = estimate_score(record, wall_references());
  EXPECT_NEAR(to_deg(score.T_world_map.yaw), 3.0, 0.3);
  EXPECT_LT(score.map.value().nearest_mean_m, 0.05);
  EXPECT_NEAR(score.pose.ate_max_m, std::hypot(6.0, 6.0) * to_rad(3.0), 0.03);
}

TEST(EstimateScore, PlacesAGivenMapWhereTheSurveySays) {
  RunReferences references = wall_references();
  references.T_world_map = Pose2{0.5, 0.0, 0.0};
  EXPECT_NEAR(estimate_score(perfect_run(), references).pose.ate_rmse_m, 0.5, 1e-9);
}

TEST(EstimateScore, ScoresLocalizationOnAKnownMapAndEachKidnap) {
  RunRecord record = perfect_run();
  for (const StampedPose& pose : record.T_map_body)
    record.confidences.push_back({.stamp = pose.stamp, .confidence = 0.9});
  RunReferences references = wall_references();
  references.kidnaps = {1s, 2s};
  const EstimateScore score = estimate_score(record, references);
  ASSERT_TRUE(score.known_map);
  EXPECT_NEAR(score.known_map->localization.min_confidence, 0.9, 1e-12);
  EXPECT_EQ(score.known_map->kidnaps.size(), 2U);
}

TEST(EstimateScore, AReportOfLostLocalizationBelongsToTheLastKidnapBeforeIt) {
  RunRecord record = perfect_run();
  record.confidences = {{.stamp = 0s, .confidence = 0.9}, {.stamp = 3s, .confidence = 0.0, .is_lost = true}};
  RunReferences references = wall_references();
  references.kidnaps = {1s, 2s};
  const EstimateScore score = estimate_score(record, references);
  ASSERT_TRUE(score.known_map);
  EXPECT_FALSE(score.known_map->kidnaps.at(0).time_to_detect_s);
  EXPECT_DOUBLE_EQ(score.known_map->kidnaps.at(1).time_to_detect_s.value_or(0.0), 1.0);
}

}  // namespace
}  // namespace patrol::score::run_score_test
