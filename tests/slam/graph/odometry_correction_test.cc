#include "slam/graph/odometry_correction.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/random.h"
#include "tests/support/pose_near.h"

namespace patrol::slam::odometry_correction_test {
namespace {

constexpr OdometryCorrection::Noise kNoise{.std_m = 0.005, .std_rad = 0.005};
constexpr double kDistanceScale = 0.93, kTurnScale = 0.95, kSteering_rad_per_m = 0.05;

/// Motions of 0.1 m along curves of both signs, and odometry that the values above correct.
struct Drive {
  RandomStream draws{1, "test/odometry_correction"};

  Pose2 odometry(std::uint64_t step) const { return {0.1, 0.0, 0.05 * std::sin(0.02 * static_cast<double>(step))}; }
  Pose2 matched(std::uint64_t step) const {
    const Pose2 o = odometry(step);
    const double yaw = kTurnScale * o.yaw + kSteering_rad_per_m * o.x;
    const double aside = 0.5 * (yaw - o.yaw);
    return {kDistanceScale * o.x * std::cos(aside) + kNoise.std_m * draws.normal(step, 0),
            kDistanceScale * o.x * std::sin(aside) + kNoise.std_m * draws.normal(step, 1),
            yaw + kNoise.std_rad * draws.normal(step, 2)};
  }
};

OdometryCorrection after_100_meters(bool is_distance_determined) {
  OdometryCorrection correction;
  const Drive drive;
  for (std::uint64_t step = 0; step < 1000; ++step)
    correction.update(drive.odometry(step), drive.matched(step), kNoise, is_distance_determined);
  return correction;
}

TEST(OdometryCorrection, IsNothingAtFirst) {
  EXPECT_THAT(OdometryCorrection().corrected({0.3, 0.01, -0.2}), test::Pose2Near(Pose2{0.3, 0.01, -0.2}, 1e-12, 1e-12));
}

TEST(OdometryCorrection, FindsScalesToTwoPercentAndSteeringTo5MilliradiansPerMeterIn100Meters) {
  const OdometryCorrection correction = after_100_meters(true);
  EXPECT_NEAR(correction.values().distance_scale, kDistanceScale, 0.01);
  EXPECT_NEAR(correction.values().turn_scale, kTurnScale, 0.02);
  EXPECT_NEAR(correction.values().steering_rad_per_m, kSteering_rad_per_m, 0.005);
}

TEST(OdometryCorrection, BackwardsTheSteeringBiasTurnsTheOtherWay) {
  const OdometryCorrection correction = after_100_meters(true);
  const Pose2 forth = correction.corrected({0.5, 0.0, 0.0}), back = correction.corrected({-0.5, 0.0, 0.0});
  EXPECT_NEAR(forth.yaw, 0.5 * kSteering_rad_per_m, 0.0025);
  EXPECT_THAT(forth * back, test::Pose2Near(Pose2{}, 1e-3, 1e-9));  // an arc, and back along it
}

TEST(OdometryCorrection, OneMotionInTwentyThatIsHalfAMeterOffChangesNoScaleByMoreThanTwoPercent) {
  OdometryCorrection correction;
  const Drive drive;
  for (std::uint64_t step = 0; step < 1000; ++step) {
    const Pose2 wrong = step % 20 == 7 ? Pose2{0.5, 0.0, 0.3} : Pose2{};
    correction.update(drive.odometry(step), drive.matched(step) * wrong, kNoise, true);
  }
  EXPECT_NEAR(correction.values().distance_scale, kDistanceScale, 0.02);
  EXPECT_NEAR(correction.values().turn_scale, kTurnScale, 0.03);
  EXPECT_NEAR(correction.values().steering_rad_per_m, kSteering_rad_per_m, 0.01);
}

TEST(OdometryCorrection, ADistanceThatTheScansDoNotDetermineIsNotUsedButTheTurnIs) {
  const OdometryCorrection correction = after_100_meters(false);
  EXPECT_DOUBLE_EQ(correction.values().distance_scale, 1.0);
  EXPECT_NEAR(correction.values().steering_rad_per_m, kSteering_rad_per_m, 0.005);
}

TEST(OdometryCorrection, ARobotThatStandsSaysNothing) {
  OdometryCorrection correction;
  for (int step = 0; step < 1000; ++step) correction.update({}, {0.001, 0.0, 0.002}, kNoise, true);
  EXPECT_DOUBLE_EQ(correction.values().turn_scale, 1.0);
  EXPECT_DOUBLE_EQ(correction.values().steering_rad_per_m, 0.0);
}

}  // namespace
}  // namespace patrol::slam::odometry_correction_test
