#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "plan/navigation/recovery_sequence.h"
#include "tests/plan/kinematic_drive.h"

namespace patrol::plan::recoveries_test {
namespace {

using namespace std::chrono_literals;
using test::RoomWorld;

Costmap make_empty_costmap() {
  const RobotDescription robot = make_robot();
  return Costmap({}, Footprint(robot.footprint_m, 1), {});
}

/// Costmap with an obstacle of the scan 1 m ahead of the origin.
Costmap make_costmap_with_obstacle() {
  Costmap costmap = make_empty_costmap();
  costmap.add_scan(RoomWorld().add_post(1.0, 0.0, 0.1).scan({}, {.beams = 720}), {});
  return costmap;
}

NavigatorSettings make_settings(const std::vector<std::string>& recoveries) {
  NavigatorSettings settings;
  settings.recovery.behaviors = recoveries;
  settings.blocked_timeout_s = 3.0;
  settings.recovery.back_up_duration_s = 2.0;
  settings.recovery.back_up_speed_mps = 0.1;
  settings.turn_in_place_rate_radps = 0.5;
  settings.recovery.max_attempts = 4;
  return settings;
}

TEST(Recoveries, WaitStandsForItsTimeAndKeepsTheCostmap) {
  Costmap costmap = make_costmap_with_obstacle();
  const std::size_t num_obstacles = costmap.num_scan_obstacles();
  const auto wait = make_recovery("wait", make_settings({}));
  wait->begin(10s, {}, costmap);
  EXPECT_EQ(costmap.num_scan_obstacles(), num_obstacles);
  ASSERT_TRUE(wait->step(12990ms, {}));
  EXPECT_EQ(wait->step(12990ms, {})->vx_mps, 0.0);
  EXPECT_FALSE(wait->step(13s, {}));
}

TEST(Recoveries, ClearCostmapClearsAndIsCompletedAtOnce) {
  Costmap costmap = make_costmap_with_obstacle();
  ASSERT_GT(costmap.num_scan_obstacles(), 0U);
  const auto clear = make_recovery("clear_costmap", make_settings({}));
  clear->begin(10s, {}, costmap);
  EXPECT_EQ(costmap.num_scan_obstacles(), 0U);
  EXPECT_FALSE(clear->step(10s, {}));
}

TEST(Recoveries, BackUpDrivesBackwardsForItsTime) {
  Costmap costmap = make_costmap_with_obstacle();
  const auto back_up = make_recovery("back_up", make_settings({}));
  back_up->begin(10s, {}, costmap);
  EXPECT_EQ(costmap.num_scan_obstacles(), 0U);
  ASSERT_TRUE(back_up->step(11900ms, {}));
  EXPECT_EQ(back_up->step(11900ms, {})->vx_mps, -0.1);
  EXPECT_FALSE(back_up->step(12s, {}));
}

TEST(Recoveries, SpinEndsAfterOneTurnOrItsTimeout) {
  Costmap costmap = make_empty_costmap();
  const auto spin = make_recovery("spin", make_settings({}));
  for (const double rate_radps : {0.5, 0.1}) {  // a robot that turns as commanded, and one that slips
    spin->begin(10s, {}, costmap);
    double time_s = 10.0;
    while (spin->step(from_seconds(time_s), {0.0, 0.0, wrap_angle(rate_radps * (time_s - 10.0))})) {
      EXPECT_EQ(spin->step(from_seconds(time_s), {0.0, 0.0, wrap_angle(rate_radps * (time_s - 10.0))})->yaw_rate_radps,
                0.5);
      time_s += 0.05;
      ASSERT_LT(time_s, 60.0);
    }
    EXPECT_NEAR(time_s - 10.0, rate_radps == 0.5 ? 2.0 * std::numbers::pi / 0.5 : 4.0 * std::numbers::pi / 0.5, 0.051);
  }
}

TEST(RecoverySequence, TakesTheBehaviorsInTurnUpToItsLimit) {
  Costmap costmap = make_empty_costmap();
  RecoverySequence sequence(make_settings({"wait", "back_up"}));
  std::vector<std::string> sentences;
  for (int i = 0; i < 4; ++i) sentences.push_back(sequence.begin_next(10s, {}, costmap));
  EXPECT_THAT(sentences, ::testing::ElementsAre("Recovery: waiting.", "Recovery: backing up.", "Recovery: waiting.",
                                                "Recovery: backing up."));
  EXPECT_FALSE(sequence.is_exhausted());
  sequence.begin_next(10s, {}, costmap);
  EXPECT_TRUE(sequence.is_exhausted());
  sequence.reset();
  EXPECT_FALSE(sequence.is_exhausted());
  EXPECT_STREQ(sequence.begin_next(10s, {}, costmap), "Recovery: waiting.");
}

TEST(RecoverySequence, EndsARecoveryThatHasNoRoom) {
  Costmap costmap = make_empty_costmap();
  RecoverySequence sequence(make_settings({"back_up"}));
  sequence.begin_next(10s, {}, costmap);
  EXPECT_TRUE(sequence.step(10s, {}, costmap));
  costmap.add_scan(RoomWorld().add_wall(-0.42, -1.0, -0.42, 1.0).scan({}, {.beams = 720}), {});
  EXPECT_FALSE(sequence.step(10s, {}, costmap));
}

TEST(Recoveries, UnknownNamesAreRefusedWithThoseAllowed) {
  EXPECT_THAT(
      [] { make_recovery("jump", make_settings({})); },
      ::testing::ThrowsMessage<InputError>(::testing::HasSubstr("must be one of wait, clear_costmap, back_up, spin")));
}

}  // namespace
}  // namespace patrol::plan::recoveries_test
