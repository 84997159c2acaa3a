#include "slam/consistency/odometry_check.h"

#include <algorithm>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/slam/graph/office_world.h"

namespace patrol::slam::odometry_check_test {
namespace {

/// Two laps of 115 m in true poses, with odometry that is 3 % too long and turns by 0.01 rad per m to the left.
struct Drive {
  std::vector<Pose2> T_odom_body, T_map_body;
  std::vector<Time> stamps;

  Drive() {
    for (const test::DriveStep& step : test::drive_along(test::office_rounds(2), {})) {
      T_odom_body.push_back(step.T_odom_body);
      T_map_body.push_back(step.T_world_body);
      stamps.push_back(step.stamp);
    }
  }
  /// Changes the odometry increments of the scans from `first` to `last`.
  template <typename Change>
  void change(std::size_t first, std::size_t last, Change&& changed) {
    std::vector<Pose2> T_odom_new = {T_odom_body.front()};
    for (std::size_t k = 1; k < T_odom_body.size(); ++k) {
      const Pose2 step = T_odom_body[k - 1].inverse() * T_odom_body[k];
      T_odom_new.push_back(T_odom_new.back() * (k >= first && k < last ? changed(step) : step));
    }
    T_odom_body = T_odom_new;
  }
  OdometryHealth check() const { return check_odometry(T_odom_body, T_map_body, stamps); }
};

TEST(OdometryCheck, FindsAScaleOf3PercentAndASteeringBiasOf10MilliradiansPerMeter) {
  const OdometryHealth health = Drive().check();
  EXPECT_EQ(health.num_faulty, 0);
  EXPECT_NEAR(health.distance_m, 239.0, 5.0);
  ASSERT_TRUE(health.distance && health.turn && health.steering);
  EXPECT_NEAR(health.distance->value, 1.0 / 1.03, 0.001);
  EXPECT_NEAR(health.turn->value, 1.0, 0.005);
  EXPECT_NEAR(health.steering->value, -0.01 / 1.03, 0.001);
  EXPECT_EQ(health.delay_s, 0.0);
  EXPECT_EQ(health.num_gaps, 0U);
}

TEST(OdometryCheck, FindsDistancesThatAre15To40PercentTooShortOrTooLong) {
  for (const double factor : {0.6, 0.7, 0.85, 1.15, 1.4}) {
    Drive drive;
    drive.change(0, drive.stamps.size(), [&](const Pose2& step) { return Pose2{factor * step.x, step.y, step.yaw}; });
    const OdometryHealth health = drive.check();
    ASSERT_TRUE(health.distance) << factor;
    EXPECT_NEAR(health.distance->value, 1.0 / (1.03 * factor), 0.005) << factor;
  }
}

TEST(OdometryCheck, OdometryThatStandsFor100ScansIsConstantThere) {
  Drive drive;
  drive.change(100, 200, [](const Pose2&) { return Pose2{}; });
  const OdometryHealth health = drive.check();
  ASSERT_GE(health.faulty.size(), 1U);
  EXPECT_LE(health.faulty.size(), 2U);  // a segment at the begin or end that stands in part
  EXPECT_EQ(health.faulty[0].fault, OdometryFault::kConstant);
  EXPECT_NEAR(health.faulty[0].distance_m, 100 * 0.12, 0.7);
  EXPECT_NEAR(static_cast<double>(health.faulty[0].first_scan), 100.0, 5.0);
  EXPECT_NEAR(static_cast<double>(health.faulty[0].last_scan), 200.0, 5.0);
  EXPECT_EQ(health.faulty[0].p_map, drive.T_map_body[health.faulty[0].first_scan].position());
  EXPECT_NEAR(health.distance->value, 1.0 / 1.03, 0.001);
}

TEST(OdometryCheck, OdometryThatNeverMovesIsConstantEverywhereAndDeterminesNoScale) {
  Drive drive;
  drive.change(0, drive.stamps.size(), [](const Pose2&) { return Pose2{}; });
  const OdometryHealth health = drive.check();
  EXPECT_EQ(health.num_faulty, health.num_segments);
  EXPECT_GT(health.num_segments, 400);
  EXPECT_FALSE(health.distance || health.turn || health.steering);
}

TEST(OdometryCheck, SwappedSignsOfDistanceAndOfTurnAreReversed) {
  Drive backward;
  backward.change(0, backward.stamps.size(), [](const Pose2& step) { return Pose2{-step.x, -step.y, step.yaw}; });
  const OdometryHealth health = backward.check();
  EXPECT_GT(health.faulty_ratio(), 0.9);
  EXPECT_EQ(health.faulty[0].fault, OdometryFault::kReversed);

  Drive mirrored;
  mirrored.change(0, mirrored.stamps.size(), [](const Pose2& step) { return Pose2{step.x, step.y, -step.yaw}; });
  const OdometryHealth of_mirrored = mirrored.check();
  EXPECT_TRUE(std::ranges::any_of(of_mirrored.faulty,
                                  [](const FaultyOdometry& entry) { return entry.fault == OdometryFault::kReversed; }));
  EXPECT_GT(of_mirrored.num_faulty, 20);  // the turns at nine corners
}

TEST(OdometryCheck, AJumpOfAMeterIsOneJumpAndDoesNotChangeTheScale) {
  Drive drive;
  drive.change(300, 301, [](const Pose2& step) { return Pose2{step.x + 1.0, step.y, step.yaw}; });
  const OdometryHealth health = drive.check();
  ASSERT_EQ(health.faulty.size(), 1U);
  EXPECT_EQ(health.faulty[0].fault, OdometryFault::kJumping);
  EXPECT_NEAR(health.distance->value, 1.0 / 1.03, 0.001);
}

TEST(OdometryCheck, WheelsThatTurnTwiceAsFarForSixMetersSlip) {
  Drive drive;
  drive.change(100, 150, [](const Pose2& step) { return Pose2{2.0 * step.x, step.y, step.yaw}; });
  const OdometryHealth health = drive.check();
  ASSERT_EQ(health.faulty.size(), 1U);
  EXPECT_EQ(health.faulty[0].fault, OdometryFault::kSlipping);
  EXPECT_NEAR(health.faulty[0].distance_m, 50 * 0.12, 0.7);
}

TEST(OdometryCheck, OdometryOneScanLateIs200MillisecondsLateAndKeepsItsScales) {
  Drive drive;
  std::rotate(drive.T_odom_body.rbegin(), drive.T_odom_body.rbegin() + 1, drive.T_odom_body.rend());
  drive.T_odom_body.front() = drive.T_odom_body[1];
  const OdometryHealth health = drive.check();
  EXPECT_NEAR(health.delay_s, 0.2, 0.021);
  EXPECT_NEAR(health.distance->value, 1.0 / 1.03, 0.002);
  EXPECT_LT(health.faulty_ratio(), 0.01);
}

TEST(OdometryCheck, AGapOfFiveSecondsIsTheOnlyOne) {
  Drive drive;
  for (std::size_t k = 500; k < drive.stamps.size(); ++k) drive.stamps[k] += from_seconds(5.0);
  const OdometryHealth health = drive.check();
  EXPECT_EQ(health.num_gaps, 1U);
  EXPECT_NEAR(health.max_gap_s, 5.2, 1e-6);
  EXPECT_EQ(health.max_gap_scan, 499U);
}

TEST(OdometryCheck, OfNoScanAndOfOneHasNoSegment) {
  EXPECT_EQ(check_odometry({}, {}, {}).num_segments, 0);
  EXPECT_EQ(check_odometry({{}}, {{}}, {{}}).num_segments, 0);
}

}  // namespace
}  // namespace patrol::slam::odometry_check_test
