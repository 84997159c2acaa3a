#include "sim/locomotion/gait.h"

#include <gtest/gtest.h>

namespace patrol::sim::gait_test {
namespace {

TEST(Gait, ATrotOf0_44SecondsAndDuty0_58Stands0_2552SecondsAndSwingsTheRest) {
  const Gait gait;
  EXPECT_NEAR(gait.stance_s(), 0.2552, 1e-12);
  EXPECT_NEAR(gait.stance_s() + gait.swing_s(), gait.period_s, 1e-12);
}

TEST(Gait, DiagonalFeetStepTogetherAndTheOtherPairHalfAPeriodLater) {
  const Gait gait{.period_s = 0.4, .duty = 0.6};
  for (double cycle = 0.0; cycle < 3.0; cycle += 0.013) {
    const LegPhase front_left = leg_phase(gait, cycle, 0), front_right = leg_phase(gait, cycle, 1);
    const LegPhase later = leg_phase(gait, cycle + 0.5, 0);
    EXPECT_EQ(front_left.is_stance, leg_phase(gait, cycle, 3).is_stance);
    EXPECT_DOUBLE_EQ(front_left.fraction, leg_phase(gait, cycle, 3).fraction);
    EXPECT_EQ(front_right.is_stance, leg_phase(gait, cycle, 2).is_stance);
    EXPECT_EQ(front_right.is_stance, later.is_stance);
    EXPECT_NEAR(front_right.fraction, later.fraction, 1e-9);
  }
}

TEST(Gait, AtDuty0_6EachFootIsDown60PercentAndNeverFewerThanTwoAre) {
  const Gait gait{.period_s = 0.4, .duty = 0.6};
  int down[kNumLegs] = {};
  constexpr int kSamples = 10000;
  for (int i = 0; i < kSamples; ++i) {
    int standing = 0;
    for (int leg = 0; leg < kNumLegs; ++leg) {
      const LegPhase phase = leg_phase(gait, (i + 0.5) / kSamples, leg);
      EXPECT_GE(phase.fraction, 0.0);
      EXPECT_LT(phase.fraction, 1.0);
      standing += phase.is_stance;
      down[leg] += phase.is_stance;
    }
    EXPECT_GE(standing, 2);
  }
  for (const int samples : down) EXPECT_NEAR(samples, 6000, 1);
}

TEST(Gait, FractionsRunEvenlyFrom0To1ThroughStanceAndSwing) {
  const Gait gait{.period_s = 0.4, .duty = 0.6};
  EXPECT_NEAR(leg_phase(gait, 7.3, 0).fraction, 0.5, 1e-9);
  EXPECT_TRUE(leg_phase(gait, 7.3, 0).is_stance);
  EXPECT_NEAR(leg_phase(gait, 7.8, 0).fraction, 0.5, 1e-9);
  EXPECT_FALSE(leg_phase(gait, 7.8, 0).is_stance);
}

}  // namespace
}  // namespace patrol::sim::gait_test
