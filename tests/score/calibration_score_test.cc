#include "score/calibration_score.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

namespace patrol::score::calibration_score_test {
namespace {

/// Motion along an arc, to second order.
Pose2 arc(double length_m, double turn_rad) {
  return Pose2{0.0, 0.0, 0.5 * turn_rad} * Pose2{length_m, 0.0, 0.5 * turn_rad};
}

/// Robot on a figure of eight at 1 m/s and up to 0.5 rad/s for 60 s, with errors of odometry and gyro.
struct Ride {
  Trajectory T_odom_body, T_world_body;
  std::vector<GyroReading> gyro;
  AsBuiltTruth as_built{.stamp = {},
                        .values = {{"lidar.time_offset_s", 0.002},
                                   {"lidar.clock_drift_s_per_s", 1e-5},
                                   {"lidar.yaw_rad", 0.004},
                                   {"uwb.anchor_3.delay_m", -0.07}}};
  std::vector<Time> kidnaps;
  std::vector<TrackReading> tracks;

  Ride(double distance_scale, double rotation_scale, double gyro_bias_radps, double gyro_scale) {
    constexpr double kStep_s = 0.01;
    Pose2 T_world_now{5.0, -3.0, 1.0}, T_odom_now;
    for (int i = 0; i <= 6000; ++i) {
      const Time stamp = from_seconds(kStep_s * i);
      const double rate_radps = 0.5 * std::sin(0.2 * kStep_s * i);
      T_world_body.push_back({stamp, to_pose3(T_world_now)});
      T_odom_body.push_back({stamp, to_pose3(T_odom_now)});
      gyro.push_back({stamp, {0.0, 0.0, rate_radps / gyro_scale + gyro_bias_radps / gyro_scale}});
      T_world_now = T_world_now * arc(kStep_s, kStep_s * rate_radps);
      T_odom_now = T_odom_now * arc(kStep_s / distance_scale, kStep_s * rate_radps / rotation_scale);
    }
  }

  std::vector<TrueParameter> true_parameters(const CalibrationReferences& references = {}) const {
    return calibration_truth({T_odom_body, T_world_body, gyro, as_built, kidnaps, tracks}, references,
                             from_seconds(60.0));
  }

  std::map<std::string, double> truth(const CalibrationReferences& references = {}) const {
    std::map<std::string, double> values;
    for (const TrueParameter& parameter : true_parameters(references)) values.emplace(parameter.name, parameter.value);
    return values;
  }
};

TEST(CalibrationTruth, FitsTheScalesOfOdometryAndTheErrorsOfTheGyro) {
  const auto truth = Ride(1.02, 0.97, 0.01, 1.004).truth();
  EXPECT_NEAR(truth.at("odometry.distance_scale"), 1.02, 5e-4);  // chords of curves depend on the rotation scale
  EXPECT_NEAR(truth.at("odometry.rotation_scale"), 0.97, 3e-4);
  EXPECT_NEAR(truth.at("imu.gyro_z_bias_radps"), 0.01, 1e-4);
  EXPECT_NEAR(truth.at("imu.gyro_z_scale"), 1.004, 5e-4);
}

TEST(CalibrationTruth, EvaluatesTheTimeOffsetAtTheInstantOfTheEstimate) {
  const Ride ride(1.0, 1.0, 0.0, 1.0);
  EXPECT_NEAR(ride.truth().at("lidar.time_offset_s"), 0.0026, 1e-12) << "2 ms and 60 s of 10 ppm";
  CalibrationReferences references;
  references.lidar_clock_fault_s = [](Time) { return -0.02; };
  const auto with_fault = ride.truth(references);
  EXPECT_NEAR(with_fault.at("lidar.time_offset_s"), -0.0174, 1e-12);
  EXPECT_EQ(with_fault.at("lidar.clock_drift_s_per_s"), 1e-5);
}

TEST(CalibrationTruth, TakesYawAndAntennaDelaysAsDrawn) {
  const auto truth = Ride(1.0, 1.0, 0.0, 1.0).truth();
  EXPECT_EQ(truth.at("lidar.yaw_rad"), 0.004);
  EXPECT_EQ(truth.at("uwb.anchor_3.delay_m"), -0.07);
}

TEST(CalibrationTruth, TheYawOfATiltedLidarIsAboutTheVerticalOfTheBody) {
  Ride ride(1.0, 1.0, 0.0, 1.0);
  ride.as_built.values.emplace_back("lidar.roll_rad", 0.001);
  ride.as_built.values.emplace_back("lidar.pitch_rad", 0.002);
  const auto yaw_rad = [&](double angle_rad, const Eigen::Vector3d& axis) {
    CalibrationReferences references;
    references.R_body_lidar = Eigen::AngleAxisd(angle_rad, axis);
    return ride.truth(references).at("lidar.yaw_rad");
  };
  EXPECT_EQ(yaw_rad(0.0, Eigen::Vector3d::UnitX()), 0.004);
  EXPECT_NEAR(yaw_rad(std::numbers::pi, Eigen::Vector3d::UnitX()), -0.004, 1e-15);
  EXPECT_NEAR(yaw_rad(std::numbers::pi, Eigen::Vector3d::UnitZ()), 0.004, 1e-15);
  EXPECT_NEAR(yaw_rad(std::numbers::pi / 2.0, Eigen::Vector3d::UnitX()), 0.002, 1e-15) << "its y axis points up";
}

TEST(CalibrationTruth, LeavesOutTheSegmentOfAKidnap) {
  Ride ride(1.02, 1.0, 0.0, 1.0);
  for (std::size_t i = 3000; i < ride.T_world_body.size(); ++i) ride.T_world_body[i].pose.position.x() += 40.0;
  EXPECT_GT(std::abs(ride.truth().at("odometry.distance_scale") - 1.02), 0.05);
  ride.kidnaps = {from_seconds(30.0)};
  EXPECT_NEAR(ride.truth().at("odometry.distance_scale"), 1.02, 3e-4);
}

TEST(CalibrationTruth, LeavesOutTheGyroOfARobotThatDoesNotTurn) {
  Ride ride(1.0, 1.0, 0.01, 1.0);
  for (std::size_t i = 0; i < ride.T_world_body.size(); ++i) {
    const Pose2 straight{0.01 * static_cast<double>(i), 0.0, 0.0};
    ride.T_world_body[i].pose = ride.T_odom_body[i].pose = to_pose3(straight);
    ride.gyro[i].angular_velocity_radps = {0.0, 0.0, 0.01};
  }
  const auto truth = ride.truth();
  EXPECT_FALSE(truth.contains("imu.gyro_z_scale"));
  EXPECT_NEAR(truth.at("odometry.distance_scale"), 1.0, 1e-9);
}

TEST(CalibrationTruth, AddsWarmingAndGravityToTheDrawnBiases) {
  Ride ride(1.0, 1.0, 0.0, 1.0);
  ride.as_built.values = {{"imu.gyro_x_bias_radps", 0.004},
                          {"imu.gyro_x_warming_radps", 0.001},
                          {"imu.gyro_x_by_gravity_radps", 0.0003},
                          {"imu.accel_z_bias_mps2", -0.2},
                          {"imu.accel_z_warming_mps2", 0.02},
                          {"imu.warming_time_s", 30.0},
                          {"imu.gyro_bias_walk_radps_per_sqrt_s", 1e-5}};
  const std::vector<TrueParameter> truth = ride.true_parameters();
  const double warming = 1.0 - std::exp(-2.0);
  const auto named = [&](const char* name) { return *std::ranges::find(truth, name, &TrueParameter::name); };
  EXPECT_NEAR(named("imu.gyro_x_bias_radps").value, 0.0043 + 0.001 * warming, 1e-12);
  EXPECT_NEAR(named("imu.gyro_x_bias_radps").std, 1e-5 * std::sqrt(60.0), 1e-12);
  EXPECT_NEAR(named("imu.accel_z_bias_mps2").value, -0.2 + 0.02 * warming, 1e-12);
  EXPECT_FALSE(ride.truth().contains("imu.gyro_y_bias_radps"));
}

// The body origin is 8 cm behind the center of rotation and 2 cm to its right; one count is 1 mm.
TEST(CalibrationTruth, FitsTheCenterOfRotation) {
  Ride ride(1.0, 1.0, 0.0, 1.0);
  const Pose2 T_body_center{0.08, 0.02, 0.0};
  for (std::size_t i = 0; i < ride.T_world_body.size(); ++i) {
    const double counts = 10.0 * static_cast<double>(i);
    ride.tracks.push_back({ride.T_world_body[i].stamp, counts, counts});
    ride.T_world_body[i].pose = to_pose3(to_pose2(ride.T_world_body[i].pose) * T_body_center.inverse());
  }
  const auto truth = ride.truth();
  EXPECT_NEAR(truth.at("odometry.turn_center_x_m"), 0.08, 5e-4);  // chords of 0.2 s
  EXPECT_NEAR(truth.at("odometry.turn_center_y_m"), 0.02, 5e-4);
}

TEST(CalibrationTruth, GivesNoCenterOfRotationForARobotWithoutTracksOrTurns) {
  Ride ride(1.0, 1.0, 0.0, 1.0);
  EXPECT_FALSE(ride.truth().contains("odometry.turn_center_x_m"));
  for (std::size_t i = 0; i < ride.T_world_body.size(); ++i) {
    ride.T_world_body[i].pose = to_pose3(Pose2{0.01 * static_cast<double>(i), 0.0, 0.0});
    ride.tracks.push_back({ride.T_world_body[i].stamp, 10.0 * static_cast<double>(i), 10.0 * static_cast<double>(i)});
  }
  EXPECT_FALSE(ride.truth().contains("odometry.turn_center_x_m"));
}

TEST(CalibrationTruth, ComparesTheDistanceScaleWithTheSprockets) {
  Ride ride(1.02, 1.0, 0.0, 1.0);
  ride.as_built.values = {{"tracks.left_sprocket_scale", 1.001}, {"tracks.right_sprocket_scale", 1.005}};
  const std::vector<TrueParameter> truth = ride.true_parameters();
  const auto scale = std::ranges::find(truth, "odometry.distance_scale", &TrueParameter::name);
  ASSERT_NE(scale, truth.end());
  ASSERT_TRUE(scale->drawn);
  EXPECT_NEAR(*scale->drawn, 1.003, 1e-12);
}

TEST(CalibrationScore, WidensTheIntervalByTheToleranceOfTheTruth) {
  const ScoredParameter exact{.name = "imu.gyro_x_bias_radps", .value = 0.003, .std = 0.001, .truth = 0.0};
  ScoredParameter walked = exact;
  walked.truth_std = 0.002;
  EXPECT_FALSE(exact.holds());
  EXPECT_TRUE(walked.holds());
}

TEST(CalibrationScore, HoldsWithin1_96StandardDeviationsAndSkipsUnknownNames) {
  const CalibrationEstimate estimate{.stamp = {},
                                     .values = {{"lidar.yaw_rad", 0.0059, 0.001},
                                                {"imu.gyro_z_scale", 1.002, 0.001},
                                                {"uwb.anchor_9.delay_m", 0.1, 0.1}}};
  const std::vector<ScoredParameter> scored = calibration_score(
      estimate, {{.name = "imu.gyro_z_scale", .value = 1.0}, {.name = "lidar.yaw_rad", .value = 0.004}});
  ASSERT_EQ(scored.size(), 2U);
  EXPECT_EQ(scored[0].name, "lidar.yaw_rad");
  EXPECT_NEAR(scored[0].error(), 0.0019, 1e-12);
  EXPECT_TRUE(scored[0].holds());
  EXPECT_FALSE(scored[1].holds());
}

}  // namespace
}  // namespace patrol::score::calibration_score_test
