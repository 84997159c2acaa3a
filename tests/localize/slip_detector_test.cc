#include "localize/slip_detector.h"

#include <cmath>

#include <gtest/gtest.h>

namespace patrol::localize::slip_detector_test {
namespace {

constexpr double kDt = 0.004;

struct Drive {
  SlipDetector watch;
  int step = 0;

  Drive() : watch({.window_s = 1.0, .threshold_mps = 0.2}) {}

  /// Belts and body speed up for a time; the first evidence.
  std::optional<SlipEvidence> speed_up(double belts_mps2, double body_mps2, double duration_s, double rough_mps2 = 0.0,
                                       double std_mps2 = 0.0) {
    std::optional<SlipEvidence> evidence;
    double belts = 0.0;
    for (double t = 0.0; t < duration_s && !evidence; t += kDt) {
      ++step;
      belts += belts_mps2 * kDt;
      const double shock = step % 2 == 0 ? rough_mps2 : -rough_mps2;
      watch.add_acceleration(from_seconds(step * kDt), kDt, body_mps2 + shock, std_mps2);
      if (step % 5 == 0) evidence = watch.add_speed(from_seconds(step * kDt), belts, 0.0);
    }
    return evidence;
  }
};

TEST(SlipDetector, TracksThatMoveTheBodyAreNoEvidence) {
  EXPECT_FALSE(Drive().speed_up(1.0, 1.0, 1.5));
  EXPECT_FALSE(Drive().speed_up(1.0, 0.9, 1.5)) << "a tenth is ordinary slip";
}

TEST(SlipDetector, TracksAloneAtOneMeterPerSecondSquaredAreDetectedAtTwentyCentimetersPerSecond) {
  const auto evidence = Drive().speed_up(1.0, 0.0, 1.0);
  ASSERT_TRUE(evidence);
  EXPECT_NEAR(evidence->disagreement_mps, 0.2, 0.021);  // a reading each 20 ms
  EXPECT_NEAR(evidence->forward_mps, 0.0, 1e-9);
}

TEST(SlipDetector, TooGentleForTheWindowGoesUnnoticed) { EXPECT_FALSE(Drive().speed_up(0.15, 0.0, 3.0)); }

// 0.2 m/s and three standard deviations of the bias over the window: 0.2 + 3 * 0.2 t <= 1.0 t from 0.5 s on.
TEST(SlipDetector, AnAccelerationWithALastingErrorAsksForMore) {
  EXPECT_FALSE(Drive().speed_up(1.0, 0.0, 0.4, 0.0, 0.2));
  const auto evidence = Drive().speed_up(1.0, 0.0, 1.0, 0.0, 0.2);
  ASSERT_TRUE(evidence);
  EXPECT_NEAR(evidence->disagreement_mps, 0.5, 0.021);
}

// Half the square of 2 * 5 m/s2 each 4 ms: 0.028 m/s per step, with the root of 250 steps.
TEST(SlipDetector, FourStandardDeviationsOfARoughRideAreTheBoundSinceTheEvidence) {
  Drive drive;
  EXPECT_EQ(drive.watch.roughness_bound_mps(), 0.0);
  ASSERT_TRUE(drive.speed_up(1.0, 0.0, 1.0));
  EXPECT_NEAR(drive.watch.roughness_bound_mps(), 0.0, 1e-9);
  drive.watch.reset();
  for (int i = 0; i < 250; ++i) {
    ++drive.step;
    drive.watch.add_acceleration(from_seconds(drive.step * kDt), kDt, i % 2 == 0 ? 5.0 : -5.0);
  }
  EXPECT_NEAR(drive.watch.roughness_bound_mps(), 4.0 * 0.0283 * std::sqrt(250.0), 0.02);
}

TEST(SlipDetector, ARoughRideAsksForMore) {
  // Half the square of 2 * 5 m/s2 each 4 ms: 0.028 m/s per step, 0.2 m/s over 0.2 s; four of these on top of 0.2.
  EXPECT_FALSE(Drive().speed_up(1.0, 0.0, 0.4, 5.0));
  EXPECT_TRUE(Drive().speed_up(1.0, 0.0, 0.4));
}

}  // namespace
}  // namespace patrol::localize::slip_detector_test
