#include "localize/track_encoders.h"

#include <gtest/gtest.h>

namespace patrol::localize::track_encoders_test {
namespace {

using std::chrono::milliseconds;

TrackEncoders make_counters() { return TrackEncoders({.meters_per_tick = 0.001, .max_acceleration_mps2 = 10.0}); }

TEST(TrackEncoders, TenTicksOfAMillimeterInTwentyMillisecondsAreHalfAMeterASecond) {
  TrackEncoders counters = make_counters();
  EXPECT_FALSE(counters.add({milliseconds(0), 100, 200})) << "one reading is no way";
  const auto interval = counters.add({milliseconds(20), 110, 194});
  ASSERT_TRUE(interval);
  EXPECT_DOUBLE_EQ(interval->speed.left_mps, 0.5);
  EXPECT_DOUBLE_EQ(interval->speed.right_mps, -0.3);
  EXPECT_DOUBLE_EQ(interval->speed.mean_mps(), 0.1);
  EXPECT_DOUBLE_EQ(interval->speed.difference_mps(), -0.8);
  EXPECT_DOUBLE_EQ(interval->step_mps, 0.05);
  EXPECT_EQ(interval->middle(), milliseconds(10));
}

TEST(TrackEncoders, AreStationaryAfterThreeHundredMillisecondsWithoutATick) {
  TrackEncoders counters = make_counters();
  for (int i = 0; i <= 14; ++i) counters.add({milliseconds(20 * i), 5, 5});
  EXPECT_FALSE(counters.is_stationary());
  counters.add({milliseconds(300), 5, 5});
  EXPECT_TRUE(counters.is_stationary());
  counters.add({milliseconds(320), 5, 6});
  EXPECT_FALSE(counters.is_stationary());
}

TEST(TrackEncoders, AJumpIsDisbelievedAndASpeedThatLastsIsNot) {
  TrackEncoders counters = make_counters();
  counters.add({milliseconds(0), 0, 0});
  counters.add({milliseconds(20), 10, 10});
  EXPECT_FALSE(counters.add({milliseconds(40), 100010, 100010})) << "5000 m/s";
  EXPECT_TRUE(counters.add({milliseconds(60), 100020, 100020}));
  int refused = 0;
  for (int i = 4; i < 40; ++i)
    refused += counters.add({milliseconds(20 * i), 100020 + 100 * i, 100020 + 100 * i}) ? 0 : 1;
  EXPECT_EQ(refused, 14) << "for 0.3 s a leap to 5 m/s";
}

// Turning in place at 0.5 m/s: a restart of both counters leaves the mean unchanged.
TEST(TrackEncoders, TheSpeedUntilTheNextReadingIsNoneWhereTheCountersRestart) {
  TrackEncoders counters = make_counters();
  EXPECT_FALSE(counters.speed_until({milliseconds(0), 0, 0}));
  for (int i = 0; i <= 10; ++i) counters.add({milliseconds(20 * i), -10 * i, 10 * i});
  const auto speed = counters.speed_until({milliseconds(220), -110, 110});
  ASSERT_TRUE(speed);
  EXPECT_DOUBLE_EQ(speed->difference_mps(), 1.0);
  EXPECT_FALSE(counters.speed_until({milliseconds(220), 0, 0}));
  EXPECT_EQ(counters.last()->right, 100) << "it has been added";
}

TEST(TrackEncoders, NoIntervalIsReturnedAcrossAGapOfASecond) {
  TrackEncoders counters = make_counters();
  counters.add({milliseconds(0), 0, 0});
  EXPECT_FALSE(counters.add({milliseconds(1000), 500, 500}));
  EXPECT_TRUE(counters.add({milliseconds(1020), 510, 510}));
}

}  // namespace
}  // namespace patrol::localize::track_encoders_test
