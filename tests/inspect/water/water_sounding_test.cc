#include "inspect/water/water_sounding.h"

#include <algorithm>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/angles.h"

namespace patrol::inspect::water_sounding_test {
namespace {

AntennaGeometry mount() {
  AntennaGeometry antenna;
  antenna.yaw = {.lower_rad = -1.2, .upper_rad = 1.2, .velocity_radps = 6.0, .effort_nm = 6.0};
  antenna.pitch = {.lower_rad = -1.62, .upper_rad = 0.7, .velocity_radps = 6.0, .effort_nm = 6.0};
  return antenna;
}

/// Servos that turn at 1 rad/s to what they are told, 0.1 deg short of the yaw, and an instrument that takes a second.
class Bench {
 public:
  double stuck_from_s = 1e9;   ///< from then on the servos do not turn
  double deaf_from_s = 1e9;    ///< from then on no sounding is made
  double silent_from_s = 1e9;  ///< from then on the servos say nothing

  /// Until the soundings are over, at most 400 s. How long it took.
  double run(WaterSounding& water) {
    for (int tick = 0; tick < 20000; ++tick) {
      const Time now = from_seconds(0.02 * tick);
      if (0.02 * tick < stuck_from_s) {
        state_.yaw_rad += std::clamp(asked_.yaw_rad - 0.1 * kDegree - state_.yaw_rad, -0.02, 0.02);
        state_.pitch_rad += std::clamp(asked_.pitch_rad - state_.pitch_rad, -0.02, 0.02);
      }
      if (tick % 5 == 0 && 0.02 * tick < silent_from_s) {
        state_.stamp = now;
        told_ = state_;
      }
      if (sounding_due_ && *sounding_due_ <= now) {
        sounding_ =
            TemSounding{.stamp = now, .moment_am2 = 34.0, .gate_s = {1e-5}, .rate_tps = {1e-6}, .std_tps = {1e-8}};
        true_yaws_rad_.push_back(state_.yaw_rad);
        sounding_due_.reset();
      }
      const auto order = water.step(now, told_, sounding_);
      if (water.is_over()) return 0.02 * tick;
      if (!order) continue;
      if (const auto* antenna = std::get_if<AntennaCommand>(&*order)) asked_ = *antenna;
      if (std::holds_alternative<SoundingCommand>(*order) && 0.02 * tick < deaf_from_s)
        sounding_due_ = now + from_seconds(1.0);
    }
    ADD_FAILURE() << "never over";
    return 400.0;
  }

  const AntennaState& state() const { return state_; }
  const std::vector<double>& true_yaws_rad() const { return true_yaws_rad_; }

 private:
  AntennaCommand asked_{.stamp = {}, .yaw_rad = 0.0, .pitch_rad = -90.0 * kDegree};
  AntennaState state_{.stamp = {}, .yaw_rad = 0.0, .pitch_rad = -90.0 * kDegree};
  std::optional<AntennaState> told_;
  std::optional<TemSounding> sounding_;
  std::optional<Time> sounding_due_;
  std::vector<double> true_yaws_rad_;
};

TEST(AntennaPoses, Are35DifferentOnesFrom60DegreesRightTo60LeftAnd30UpTo30Down) {
  const std::vector<AntennaPose> poses = antenna_poses({}, mount());
  ASSERT_EQ(poses.size(), 35U);
  std::set<std::pair<int, int>> different;
  double longest_turn_rad = 0.0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    different.emplace(static_cast<int>(std::lround(poses[i].yaw_rad / kDegree)),
                      static_cast<int>(std::lround(poses[i].pitch_rad / kDegree)));
    if (i > 0) longest_turn_rad = std::max(longest_turn_rad, std::abs(poses[i].yaw_rad - poses[i - 1].yaw_rad));
  }
  EXPECT_EQ(different.size(), 35U);
  EXPECT_TRUE(different.contains({-60, -30}) && different.contains({60, 30}) && different.contains({0, 0}));
  EXPECT_NEAR(longest_turn_rad, 20.0 * kDegree, 1e-9);  // to and fro
}

TEST(AntennaPoses, WhatTheMountDoesNotReachIsRefusedByName) {
  WaterSoundingSettings settings;
  settings.max_yaw_deg = 70.0;
  try {
    antenna_poses(settings, mount());
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("stack.inspection.water.sounding.max_yaw_deg = 70: outside the "
                                                   "range of the mount: must be in [-68.8, 68.8] deg"));
  }
}

TEST(WaterSounding, Takes35SoundingsWhereTheServosReadAndStowsTheAntenna) {
  WaterSounding water({}, mount(), Time{});
  Bench bench;
  const double took_s = bench.run(water);
  ASSERT_EQ(water.soundings().size(), 35U);
  EXPECT_EQ(water.num_skipped(), 0);
  EXPECT_TRUE(water.is_stowed());
  EXPECT_NEAR(bench.state().pitch_rad, -90.0 * kDegree, 1e-9);
  for (std::size_t i = 0; i < 35; ++i)
    EXPECT_NEAR(water.soundings()[i].pose.yaw_rad, bench.true_yaws_rad()[i], 1e-9) << "still while sounding";
  EXPECT_GT(took_s, 35.0 * 1.4);
  EXPECT_LT(took_s, 100.0);
}

// 0.1 deg short in yaw is 0.1 cos(pitch) deg of axis: 30, 15, 0, 15, 30 deg give the root of (2 * 0.75 + 2 * 0.933 + 1)
// / 5 = 0.934.
TEST(WaterSounding, SaysTheErrorBetweenWhatWasAskedAndWhatWasRead) {
  WaterSounding water({}, mount(), Time{});
  Bench bench;
  bench.run(water);
  EXPECT_NEAR(water.antenna_error_deg(), 0.0934, 0.0005);
}

TEST(WaterSounding, ServosThatStickLeaveOutThreePosesThenItGivesUpAndSaysThatItIsNotStowed) {
  WaterSounding water({}, mount(), Time{});
  Bench bench;
  bench.stuck_from_s = 20.0;
  const double took_s = bench.run(water);
  EXPECT_GT(water.soundings().size(), 3U);
  EXPECT_LT(water.soundings().size(), 20U);
  EXPECT_EQ(water.num_skipped() + static_cast<int>(water.soundings().size()), 35);
  EXPECT_FALSE(water.is_stowed());
  EXPECT_LT(took_s, 20.0 + 4.0 * 8.0 + 3.0);  // three poses and the stowing, 8 s each
}

TEST(WaterSounding, AnInstrumentThatIsSilentIsGivenUpAfterThreePosesAndTheAntennaStowed) {
  WaterSounding water({}, mount(), Time{});
  Bench bench;
  bench.deaf_from_s = 0.0;
  bench.run(water);
  EXPECT_TRUE(water.soundings().empty());
  EXPECT_EQ(water.num_skipped(), 35);
  EXPECT_TRUE(water.is_stowed());
  EXPECT_EQ(water.antenna_error_deg(), 0.0);
}

TEST(WaterSounding, ServosThatSayNothingAreNotBelievedToBeThere) {
  WaterSounding water({}, mount(), Time{});
  Bench bench;
  bench.silent_from_s = 0.0;
  bench.run(water);
  EXPECT_TRUE(water.soundings().empty());
  EXPECT_FALSE(water.is_stowed());
}

}  // namespace
}  // namespace patrol::inspect::water_sounding_test
