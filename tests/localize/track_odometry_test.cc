#include "localize/track_odometry.h"

#include <array>
#include <chrono>
#include <cmath>
#include <numbers>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "tests/localize/odometry_drive.h"

namespace patrol::localize::track_odometry_test {
namespace {

using test::make_tour;
using test::make_tracked_robot;
using test::TrackedDrive;
using test::TrackedDriveSettings;

double nees(const TrackOdometry& odometry, const TrackedDrive& drive) {
  const Eigen::Vector3d error = planar_error(odometry, drive);
  return error.dot(odometry.estimate()->planar_covariance.inverse() * error);
}

/// Dead reckoning by the counters alone, as wheeled robots do it: heading by the belts' difference over the gauge.
Pose2 by_counters_alone(const Pose2& before, const TrackTicks& last, const TrackTicks& now, double meters_per_tick,
                        double gauge_m) {
  const double left = meters_per_tick * static_cast<double>(now.left - last.left);
  const double right = meters_per_tick * static_cast<double>(now.right - last.right);
  return before * Pose2{0.5 * (left + right), 0.0, (right - left) / gauge_m};
}

/// Mean of 20 values of chi-square with three degrees of freedom: 95 % lie between these (chi-square of 60, 2.5 %
/// and 97.5 %, over 20).
constexpr double kLowNees = 40.48 / 20.0, kHighNees = 83.30 / 20.0;

constexpr std::array<double, 3> kNeesTimes_s{30.0, 60.0, 120.0};

/// Mean NEES over twenty seeds, [time].
std::array<double, 3> mean_nees(const TrackedDriveSettings& plant) {
  std::array<double, 3> mean{};
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    TrackedDrive drive(make_tracked_robot(), make_tour(), plant, seed);
    TrackOdometry odometry(make_tracked_robot(), {});
    for (std::size_t i = 0; i < kNeesTimes_s.size(); ++i) {
      run(drive, odometry, kNeesTimes_s[i]);
      mean[i] += nees(odometry, drive) / 20.0;
    }
  }
  return mean;
}

TEST(TrackOdometry, NeesOverTwentySeedsIsWithinItsBoundsAfter30And60And120Seconds) {
  const std::array<double, 3> mean = mean_nees({});
  for (std::size_t i = 0; i < mean.size(); ++i) {
    EXPECT_GT(mean[i], kLowNees) << kNeesTimes_s[i] << " s";
    EXPECT_LT(mean[i], kHighNees) << kNeesTimes_s[i] << " s";
  }
}

// The lower bound is half the dimension: the filter, which is made for rough ground, is underconfident on this plant.
// Measured: 2.35, 2.61, 1.91.
TEST(TrackOdometry, OnAPlantWithParametersOfItsOwnTheNeesIsAtLeastHalfItsDimensionAndNotOverconfident) {
  const std::array<double, 3> mean = mean_nees(TrackedDriveSettings::of_data_sheets());
  for (std::size_t i = 0; i < mean.size(); ++i) {
    EXPECT_GT(mean[i], 1.5) << kNeesTimes_s[i] << " s";
    EXPECT_LT(mean[i], kHighNees) << kNeesTimes_s[i] << " s";
  }
}

// The tilt at the start hides an accelerometer bias until the robot turns: 20 mg are 0.28 m/s2 after a quarter turn,
// more than the slip detector allows.
TEST(TrackOdometry, AnAccelerometerBiasOfTheDataSheetIsNoLossOfTraction) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    TrackedDrive drive(make_tracked_robot(), make_tour(), TrackedDriveSettings::of_data_sheets(), seed);
    TrackOdometry odometry(make_tracked_robot(), {});
    run(drive, odometry, 60.0);
    EXPECT_EQ(odometry.health().num_slip_events, 0U) << "seed " << seed;
  }
}

TEST(TrackOdometry, CalibrationContainsTheBiasesAndTheCenterOfRotation) {
  const TrackOdometrySettings settings;
  TrackedDrive drive(make_tracked_robot(), make_tour(), {}, 1);
  TrackOdometry odometry(make_tracked_robot(), settings);
  EXPECT_TRUE(odometry.calibration().empty());
  run(drive, odometry, 60.0);
  const std::vector<CalibrationValue> values = odometry.calibration();
  ASSERT_EQ(values.size(), 7U);
  constexpr auto kFirst = static_cast<std::size_t>(CalibrationParameter::kGyroXBias);
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(values[i].name, kCalibrationParameters[kFirst + i].name);
  EXPECT_EQ(values[5].value, odometry.filter()->icr_m().x());
  EXPECT_EQ(values[6].value, odometry.filter()->icr_m().y());
  EXPECT_LT(values[5].std, settings.icr_x_std_m);  // the tour turns
  EXPECT_LT(values[6].std, settings.icr_y_std_m);
}

// Without rest there is no measurement of the bias by the odometry itself: 8.7 mrad/s are 30 degrees in a minute.
TEST(TrackOdometry, AGyroBiasMeasuredByOthersKeepsTheHeading) {
  for (const bool is_corrected : {false, true}) {
    TrackedDrive drive(make_tracked_robot(), make_tour(), TrackedDriveSettings::of_data_sheets(), 3);
    TrackOdometry odometry(make_tracked_robot(), {.settling_time_s = 60.0, .standstill_window_s = 10.0});
    run(drive, odometry, 7.0);
    const double before_rad = planar_error(odometry, drive).z();
    for (int i = 0; i < 11; ++i) {
      if (is_corrected) odometry.correct_gyro_bias(drive.gyro_z_bias_radps(), 1e-4);
      run(drive, odometry, 12.0 + 5.0 * i);
    }
    const double drift_deg = to_deg(std::abs(wrap_angle(planar_error(odometry, drive).z() - before_rad)));
    if (is_corrected) EXPECT_LT(drift_deg, 2.0);
    else EXPECT_GT(drift_deg, 5.0);
  }
}

// Limit: the filter has no state for the scale of the gyro. A sensitivity of 1 % (ADIS16448 data sheet; here one
// standard deviation) is 2 % of a radian and more on a tour that turns one way, twice the claimed deviation of the yaw.
// The bounds are half and twice the measured value; whoever mends it moves this case into the test above.
TEST(TrackOdometry, AGyroSensitivityOfOnePercentIsNotInTheCovariance) {
  TrackedDriveSettings plant = TrackedDriveSettings::of_data_sheets();
  plant.imu_scale = 0.01;
  const std::array<double, 3> mean = mean_nees(plant), measured = {25.0, 9.7, 7.2};
  for (std::size_t i = 0; i < mean.size(); ++i) {
    EXPECT_GT(mean[i], 0.5 * measured[i]) << kNeesTimes_s[i] << " s";
    EXPECT_LT(mean[i], 2.0 * measured[i]) << kNeesTimes_s[i] << " s";
  }
}

TEST(TrackOdometry, DriftsLessThanOnePercentAndAFifthOfCountersAlone) {
  double by_filter = 0.0, by_counters = 0.0, way = 0.0;  // m, sums over the seeds
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const RobotDescription robot = make_tracked_robot();
    TrackedDrive drive(robot, make_tour(), {}, seed);
    TrackOdometry odometry(robot, {});
    Pose2 alone;
    TrackTicks last = drive.ticks();
    while (to_seconds(drive.now()) < 120.0) {
      run(drive, odometry, to_seconds(drive.now()) + 0.02);
      const TrackTicks ticks = drive.ticks();
      // Even with the mean of the scrub known: what remains is what scrub does from turn to turn.
      alone = by_counters_alone(alone, last, ticks, 2.0 * std::numbers::pi * 0.1 / 720.0, 1.5 * robot.tracks->gauge_m);
      last = ticks;
    }
    by_filter += planar_error(odometry, drive).head<2>().norm();
    by_counters += (alone.position() - drive.T_world_body().position.head<2>()).norm();
    way += drive.way_m();
  }
  EXPECT_LT(by_filter, 0.01 * way);
  EXPECT_LT(by_filter, 0.2 * by_counters);
}

TEST(TrackOdometry, WithoutNoiseADriveOfThirtySevenMetersIsExactToOneCentimeter) {
  const TrackedDriveSettings quiet = TrackedDriveSettings::without_noise();
  TrackedDrive drive(make_tracked_robot(), make_tour(), quiet, 1);
  TrackOdometry odometry(make_tracked_robot(), {.ticks_per_sprocket_turn = quiet.ticks_per_sprocket_turn});
  run(drive, odometry, 90.0);
  EXPECT_GT(drive.way_m(), 35.0);
  EXPECT_LT(planar_error(odometry, drive).head<2>().norm(), 0.01);
  EXPECT_LT(std::abs(planar_error(odometry, drive).z()), 1e-3);
}

TEST(TrackOdometry, StepsOfTheCountersDoNotMoveTheScale) {
  TrackedDriveSettings coarse = TrackedDriveSettings::without_noise();
  coarse.ticks_per_sprocket_turn = 360.0;  // 1.7 mm, 0.09 m/s in an interval of 20 ms
  TrackedDrive drive(make_tracked_robot(), make_tour(), coarse, 1);
  TrackOdometry odometry(make_tracked_robot(), {.ticks_per_sprocket_turn = 360.0});
  run(drive, odometry, 63.0);
  // Weighing slip by the reading itself drives it to 0.136 in this minute.
  EXPECT_LT(std::abs(odometry.filter()->scale()), 0.003);
}

TEST(TrackOdometry, HasNoEstimateBeforeRestAndStartsAtTheOrigin) {
  TrackedDrive drive(make_tracked_robot(), make_tour(), {}, 3);
  TrackOdometry odometry(make_tracked_robot(), {});
  EXPECT_FALSE(odometry.estimate());
  EXPECT_FALSE(odometry.T_odom_body_at(Time{0}));
  run(drive, odometry, 1.4);
  EXPECT_FALSE(odometry.estimate()) << "it has not stood for 1.5 s";
  run(drive, odometry, 2.9);
  ASSERT_TRUE(odometry.estimate());
  EXPECT_LT(planar_error(odometry, drive).norm(), 1e-3);
  // Two windows of a second: 3.5e-4 / sqrt(2 * 0.8 s), four of these.
  EXPECT_NEAR(odometry.filter()->gyro_bias_radps().z(), drive.gyro_z_bias_radps(), 4.0 * 3.5e-4 / std::sqrt(1.6));
}

TEST(TrackOdometry, WithoutRestAnEstimateIsGivenAfterSixSeconds) {
  TrackedDrive drive(
      make_tracked_robot(),
      [](double, const Pose3&) {
        return test::Belts{0.3, 0.3};
      },
      {}, 4);
  TrackOdometry odometry(make_tracked_robot(), {});
  run(drive, odometry, 5.9);
  EXPECT_FALSE(odometry.estimate());
  run(drive, odometry, 6.1);
  ASSERT_TRUE(odometry.estimate());
  EXPECT_GT(odometry.health().gyro_z_bias_std_radps, 0.004) << "nothing has shown the bias";
}

TEST(TrackOdometry, PosesOfAtLeastTwoSecondsAreBufferedWithTheirTilt) {
  TrackedDrive drive(make_tracked_robot(), make_tour(), {}, 11);
  TrackOdometry odometry(make_tracked_robot(), for_plant());
  run(drive, odometry, 10.0);
  const Time then = drive.now();
  const Pose3 truth = drive.T_world_body();
  run(drive, odometry, 11.5);
  const std::optional<Pose3> remembered = odometry.T_odom_body_at(then);
  ASSERT_TRUE(remembered);
  EXPECT_LT(remembered->rotation.angularDistance(truth.rotation), 0.5 * kDegree);
  EXPECT_FALSE(odometry.T_odom_body_at(then - std::chrono::seconds(9)));
  EXPECT_TRUE(odometry.T_odom_body_at(drive.now() + std::chrono::milliseconds(100)));
  EXPECT_FALSE(odometry.T_odom_body_at(drive.now() + std::chrono::milliseconds(200)));
}

TEST(TrackOdometry, ARobotWithoutTracksOrImuIsRefusedWithASentence) {
  RobotDescription robot = make_tracked_robot();
  robot.T_body_sensor.erase("imu");
  EXPECT_THROW(TrackOdometry(robot, {}), InputError);
  robot.tracks.reset();
  try {
    TrackOdometry odometry(robot, {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "robot tracked: has neither tracks nor wheels on both sides that are not steered");
  }
  EXPECT_THROW(TrackOdometry(make_tracked_robot(), {.slip_correlation_m = 0.0}), InputError);
}

}  // namespace
}  // namespace patrol::localize::track_odometry_test
