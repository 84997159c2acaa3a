#include "app/check/measurements.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/app/check/straight_record.h"

namespace patrol::app::measurements_test {
namespace {

using test::straight_record;

/// Turn to the left about a point that lies on the y axis of the robot; the true yaw is `ratio` of the commanded one.
DriveRecord circle_record(double radius_m, double ratio, double gauge_m) {
  DriveRecord record;
  constexpr int kNumSamples = 400;
  for (int i = 0; i <= kNumSamples; ++i) {
    DriveSample sample;
    sample.time_s = kSamplePeriod_s * i;
    sample.commanded_yaw_rad = 2.0 * M_PI * i / kNumSamples;
    sample.yaw_rad = ratio * sample.commanded_yaw_rad;
    sample.T_start_center = {radius_m * std::sin(sample.yaw_rad), radius_m * (1.0 - std::cos(sample.yaw_rad)),
                             sample.yaw_rad};
    sample.left_travel_m = (radius_m - 0.5 * gauge_m) * sample.yaw_rad;
    sample.right_travel_m = (radius_m + 0.5 * gauge_m) * sample.yaw_rad;
    record.samples.push_back(sample);
  }
  return record;
}

TEST(CheckMeasurements, SlipIsTheFractionOfTheTravelThatTheGroundDoesNotShow) {
  EXPECT_NEAR(slip_ratio(straight_record(0.45, 0.6, 5.0)), 0.25, 1e-9);
  EXPECT_NEAR(slip_ratio(straight_record(0.6, 0.6, 5.0)), 0.0, 1e-12);
}

TEST(CheckMeasurements, ARobotWithoutTravelHasNoSlip) { EXPECT_EQ(slip_ratio(straight_record(0.0, 0.0, 1.0)), 0.0); }

TEST(CheckMeasurements, TheCircleHasTheRadiusAndTheCenterOfTheDrive) {
  const DriveRecord record = circle_record(2.0, 1.0, 0.6);
  const Circle circle = driven_circle(record, 0.1, 0.9);
  EXPECT_NEAR(circle.radius_m, 2.0, 1e-9);
  EXPECT_NEAR((circle.center_m - Eigen::Vector2d(0.0, 2.0)).norm(), 0.0, 1e-9);
}

TEST(CheckMeasurements, TheYawRatioIsTrueOverCommandedYaw) {
  EXPECT_NEAR(yaw_ratio(circle_record(0.0, 0.9, 0.6)), 0.9, 1e-12);
}

TEST(CheckMeasurements, TheEffectiveGaugeOfADriveWithoutSlipIsTheGeometricOne) {
  EXPECT_NEAR(effective_gauge_ratio(circle_record(0.0, 0.9, 0.6), 0.6), 1.0, 1e-12);
  EXPECT_NEAR(effective_gauge_ratio(circle_record(0.0, 0.9, 0.9), 0.6), 1.5, 1e-12);
}

// From 1 m/s with 0.8 m/s2 the robot stops after 1.25 s and 0.625 m.
TEST(CheckMeasurements, AStopHasDistanceAndTimeOfAConstantDecelerationToTwoSamples) {
  DriveRecord record = straight_record(1.0, 1.0, 2.0);
  const DriveSample begin = record.samples.back();
  constexpr double kDeceleration_mps2 = 0.8;
  for (double t = kSamplePeriod_s; t < 3.0; t += kSamplePeriod_s) {
    DriveSample sample = begin;
    const double moving_s = std::min(t, 1.0 / kDeceleration_mps2);
    sample.time_s += t;
    sample.commanded_speed_mps = 0.0;
    sample.speed_mps = 1.0 - kDeceleration_mps2 * moving_s;
    sample.ground_travel_m += moving_s - 0.5 * kDeceleration_mps2 * moving_s * moving_s;
    record.samples.push_back(sample);
  }
  const Stop stop = measure_stop(record, 0.02);
  EXPECT_TRUE(stop.is_at_rest);
  EXPECT_NEAR(stop.speed_mps, 1.0, 1e-9);
  EXPECT_NEAR(stop.distance_m, 0.625, 0.001);
  EXPECT_NEAR(stop.duration_s, 1.25, 2.0 * kSamplePeriod_s);
}

TEST(CheckMeasurements, ARobotThatRollsOnIsNotAtRest) {
  DriveRecord record = straight_record(1.0, 1.0, 1.0);
  for (int i = 0; i < 100; ++i) {
    record.samples.push_back(record.samples.back());
    record.samples.back().commanded_speed_mps = 0.0;
  }
  EXPECT_FALSE(measure_stop(record, 0.02).is_at_rest);
}

}  // namespace
}  // namespace patrol::app::measurements_test
