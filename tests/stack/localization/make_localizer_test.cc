#include "stack/localization/make_localizer.h"

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "tests/stack/standing_quadruped.h"

namespace patrol::stack::make_localizer_test {
namespace {

/// Variances of the pose that is published in a small room, where a scan determines it to millimeters.
Eigen::Vector3d published_variances(const LocalizerStart& start, double map_std_m, double map_yaw_std_deg) {
  StackSettings settings;
  settings.registration.map_std_m = map_std_m;
  settings.registration.map_yaw_std_deg = map_yaw_std_deg;
  const auto localizer = make_localizer(settings, test::make_quadruped(), {}, start, 1);
  localizer->set_initial_pose({}, Eigen::Vector3d(1e-4, 1e-4, 1e-4).asDiagonal());
  const test::RoomWorld room = small_room();
  StackOutput output;
  PoseEstimate pose;
  for (int i = 0; i <= 20; ++i) {
    const Pose2 truth{0.05 * i, 0.0, 0.0};
    LevelScan scan = room.scan(truth, {});
    scan.stamp = from_seconds(0.1 * i);
    pose = localizer->update(scan, truth, output);
  }
  return pose.covariance.diagonal();
}

// A scan match is known to millimeters; the deformation of the map is that of the settings.
TEST(MakeLocalizer, PublishedCovarianceContainsTheDeformationOfTheMapWithAndWithoutAGivenMap) {
  for (const LocalizerStart& start : {LocalizerStart{}, LocalizerStart{.map = map_of_small_room()}}) {
    const Eigen::Vector3d of_matches = published_variances(start, 0.0, 0.0);
    const Eigen::Vector3d with_map = published_variances(start, 0.03, 0.15);
    EXPECT_GT(of_matches.minCoeff(), 0.0);
    const Eigen::Vector3d expected = Eigen::Vector3d(0.03, 0.03, to_rad(0.15)).cwiseAbs2();
    EXPECT_LT((with_map - of_matches - expected).cwiseQuotient(expected).cwiseAbs().maxCoeff(), 1e-9);
  }
}

RobotDescription quadruped_with_uwb() {
  RobotDescription robot = test::make_quadruped();
  robot.T_body_sensor["uwb"] = Pose3{{0.1, 0.0, 0.1}, Eigen::Quaterniond::Identity()};
  return robot;
}

/// Range without noise to an anchor by a radio with a bias.
RangeWithOdometry exact_range(const UwbAnchor& anchor, const UwbCalibration& radio, const RobotDescription& robot,
                              const Pose2& truth, const Pose2& odometry, Time stamp) {
  const Eigen::Vector3d antenna =
      uwb_antenna_in_level(Eigen::Quaterniond::Identity(), robot.T_body("uwb"), robot.body_height_m());
  return {.range = {.stamp = stamp,
                    .anchor = anchor.number,
                    .range_m = predict_uwb_range(anchor, truth, antenna, radio).range_m},
          .T_odom_body = {{odometry.x, odometry.y, 0.0}, Eigen::Quaterniond::Identity()},
          .height_m = robot.body_height_m()};
}

/// Confidence after ranges to an anchor above a quadruped, whose likelihood is 0 at an error of half the height of the
/// body. They are exact for a radio with the given bias.
LocalizationConfidence confidence_of_ranges(const LocalizerStart& start, const UwbCalibration& radio) {
  StackSettings settings;
  settings.localization.ranges = {.range_std_m = 0.03, .nlos_probability = 0.0, .outlier_probability = 1e-6};
  settings.uwb_filter.bias_distance_m = radio.distance_m;
  settings.uwb_filter.bias_m = radio.bias_m;
  const RobotDescription robot = quadruped_with_uwb();
  Route site;
  site.anchors = {{.number = 4, .p_m = {1.0, 0.5, 3.0}}};
  const auto localizer = make_localizer(settings, robot, site, start, 1);
  localizer->set_initial_pose({}, Eigen::Vector3d(1e-4, 1e-4, 1e-4).asDiagonal());
  const test::RoomWorld room = small_room();
  StackOutput output;
  PoseEstimate pose;
  for (int i = 0; i <= 60; ++i) {
    const Pose2 truth{0.02 * i, 0.0, 0.0};
    localizer->add(exact_range(site.anchors[0], radio, robot, truth, truth, from_seconds(0.1 * i)));
    LevelScan scan = room.scan(truth, {});
    scan.stamp = from_seconds(0.1 * i);
    pose = localizer->update(scan, truth, output);
    if (i == 20 && localizer->is_mapping()) localizer->finish_map(pose);
    if (i == 40) localizer->set_anchors(site.anchors);
  }
  return all_of<LocalizationConfidence>(output.take_messages()).back();
}

// The anchors are above the ground, the poses of the particles at the height of the body.
TEST(MakeLocalizer, ExactRangesOfAQuadrupedConfirmThePoseWithAGivenMapAndAfterMapping) {
  for (const LocalizerStart& start :
       {LocalizerStart{.map = map_of_small_room()}, LocalizerStart{.has_mapping_drive = true}}) {
    const LocalizationConfidence confidence = confidence_of_ranges(start, {});
    EXPECT_FALSE(confidence.is_lost);
    EXPECT_GT(confidence.confidence, 0.9);
  }
}

TEST(MakeLocalizer, RangesHaveTheBiasOfTheSettings) {
  const LocalizationConfidence confidence =
      confidence_of_ranges({.map = map_of_small_room()}, {.distance_m = {1.0, 9.0}, .bias_m = {0.5, 0.5}});
  EXPECT_FALSE(confidence.is_lost);
  EXPECT_GT(confidence.confidence, 0.9);
}

/// Error at the end of 20 m along a corridor without an end in sight, where odometry is 2 % too long. The ranges to an
/// anchor ahead are exact for a radio whose bias grows with the distance by 10 %.
double corridor_error_m(const UwbCalibration& of_settings) {
  const UwbCalibration radio{.distance_m = {0.0, 30.0}, .bias_m = {0.0, 3.0}};
  StackSettings settings;
  slam::RangeUpdateSettings& ranges = settings.slam.graph.ranges;
  ranges.range_std_m = 0.02;
  ranges.common_std_m = ranges.anchor_delay_std_m = 0.01;
  settings.uwb_filter.bias_distance_m = of_settings.distance_m;
  settings.uwb_filter.bias_m = of_settings.bias_m;
  const RobotDescription robot = quadruped_with_uwb();
  Route site;
  site.anchors = {{.number = 4, .p_m = {26.0, 1.0, 2.0}}};
  const auto localizer = make_localizer(settings, robot, site, {}, 1);
  localizer->set_initial_pose({}, Eigen::Vector3d(1e-4, 1e-4, 1e-4).asDiagonal());
  test::RoomWorld corridor;
  corridor.add_wall(-100.0, -2.0, 100.0, -2.0).add_wall(-100.0, 2.0, 100.0, 2.0);
  StackOutput output;
  PoseEstimate pose;
  for (int i = 0; i <= 200; ++i) {
    const Pose2 truth{0.1 * i, 0.0, 0.0}, odometry{0.102 * i, 0.0, 0.0};
    localizer->add(exact_range(site.anchors[0], radio, robot, truth, odometry, from_seconds(0.1 * i)));
    LevelScan scan = corridor.scan(truth, {});
    scan.stamp = from_seconds(0.1 * i);
    pose = localizer->update(scan, odometry, output);
  }
  return std::abs(pose.T_map_body.x - 20.0);
}

// Ranges without the correction are rejected, and the error is that of odometry.
TEST(MakeLocalizer, SlamHalvesTheErrorOfOdometryInACorridorByRangesWithTheBiasOfTheSettings) {
  EXPECT_LT(corridor_error_m({.distance_m = {0.0, 30.0}, .bias_m = {0.0, 3.0}}), 0.24);
  EXPECT_NEAR(corridor_error_m({}), 0.4, 0.01);
}

}  // namespace
}  // namespace patrol::stack::make_localizer_test
