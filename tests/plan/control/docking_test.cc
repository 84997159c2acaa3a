#include "plan/control/docking.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "core/random.h"
#include "localize/dock_detector.h"
#include "tests/plan/tracked_plant.h"
#include "tests/support/dock_world.h"
#include "tests/support/pose_near.h"

namespace patrol::plan::docking_test {
namespace {

using test::RoomWorld;

constexpr int kTicksPerSecond = 20;
constexpr double kPeriod_s = 1.0 / kTicksPerSecond;

/// The robot's own reckoning, which drifts: way by the tracks, heading by a gyro.
struct Odometry {
  double way_scale = 1.03;
  double turn_scale = 1.01;
  double turn_bias_radps = 0.0;
  Pose2 T_odom_body{4.0, -2.0, 1.0};

  void follow(const Pose2& motion) {
    const double turn_rad = turn_scale * motion.yaw + turn_bias_radps * kPeriod_s;
    T_odom_body = T_odom_body * Pose2{way_scale * motion.x, way_scale * motion.y, turn_rad};
  }
};

struct DockRun {
  DockingStatus status = DockingStatus::kIdle;
  double time_s = 0.0;
  Pose2 T_docked_body;
  std::vector<std::string> texts;
  double farthest_m = 0.0;  ///< ahead along the dock's axis
};

struct DockCase {
  Pose2 T_docked_body;  ///< at the start
  TrackedPlant plant;
  Odometry odometry;
  double range_std_m = 0.025;
  std::uint64_t seed = 0;
  double shove_at_s = -1.0;    ///< something pushes the robot 8 cm aside
  double hidden_from_s = 1e9;  ///< somebody stands before the post
  double hidden_to_s = 1e9;
};

/// Closed loop at 20 Hz with scans at 10 Hz through the real detector. The dock is the world's origin.
DockRun run_docking(DockCase c, const DockingSettings& settings = {}, double timeout_s = 150.0) {
  const RoomWorld post = test::make_dock_world({}, test::make_dock_profile());
  RoomWorld hidden = post;
  hidden.add_wall(0.4, -0.6, 0.4, 0.6);
  const localize::DockDetector detector({}, test::make_dock_profile());
  const RandomStream noise(c.seed, "test/lidar");
  Docking docking(settings);
  docking.dock(Time{});
  c.plant.T_map_body = c.T_docked_body;
  DockRun run;
  const int ticks = static_cast<int>(timeout_s * kTicksPerSecond);
  for (int tick = 0; tick < ticks; ++tick) {
    const double time_s = tick * kPeriod_s;
    const Time now = from_seconds(time_s);
    if (tick % 2 == 0) {
      const bool is_hidden = time_s >= c.hidden_from_s && time_s < c.hidden_to_s;
      const LevelScan scan = test::scan_from_mast(is_hidden ? hidden : post, c.plant.T_map_body, now, c.range_std_m,
                                                  noise, static_cast<std::uint64_t>(tick));
      // Before the first look the map says where the post is, 10 cm and 3 degrees off.
      const Pose2 by_map = Pose2{0.1, -0.1, 0.05} * c.T_docked_body.inverse();
      const Pose2 expected = docking.T_level_docked(c.odometry.T_odom_body).value_or(by_map);
      if (const auto detection = detector.detect(scan, expected)) docking.add(*detection, c.odometry.T_odom_body);
    }
    const DockingStep step = docking.step(now, c.odometry.T_odom_body);
    if (!step.text.empty()) run.texts.push_back(step.text);
    EXPECT_EQ(step.command.vy_mps, 0.0);
    const Pose2 before = c.plant.T_map_body;
    c.plant.move(step.command, kPeriod_s);
    c.odometry.follow(before.inverse() * c.plant.T_map_body);
    if (time_s >= c.shove_at_s && time_s < c.shove_at_s + kPeriod_s) {
      c.plant.T_map_body.y += 0.08;  // the tracks slide: odometry sees nothing
    }
    run.status = step.status;
    run.time_s = time_s;
    run.T_docked_body = c.plant.T_map_body;
    run.farthest_m = std::max(run.farthest_m, run.T_docked_body.x);
    if (step.status == DockingStatus::kDocked || step.status == DockingStatus::kFailed) break;
  }
  return run;
}

// From anywhere about the staging pose; tracks that slip 10-40 % in turning about a point up to 5 cm off, 50 ms late,
// odometry 3 % and 1 % wrong, ranges to 2-3 cm.
TEST(Docking, FiftySeedsEndWithinTwoCentimetresAndOneDegree) {
  double worst_m = 0.0, worst_rad = 0.0, worst_s = 0.0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const RandomStream stream(seed, "test/docking");
    DockCase c{.T_docked_body = {-1.35 + 0.2 * (stream.uniform(0) - 0.5), 0.2 * (stream.uniform(1) - 0.5),
                                 0.3 * (stream.uniform(2) - 0.5)},
               .plant = {},
               .odometry = {},
               .range_std_m = 0.02 + 0.01 * stream.uniform(3),
               .seed = seed};
    c.plant.turn_slip = 0.1 + 0.3 * stream.uniform(4);
    c.plant.turn_center_m = 0.1 * (stream.uniform(5) - 0.5);
    c.odometry.way_scale = 1.0 + 0.03 * stream.normal(6);
    c.odometry.turn_scale = 1.0 + 0.01 * stream.normal(7);
    const DockRun run = run_docking(c);
    ASSERT_EQ(run.status, DockingStatus::kDocked)
        << "seed " << seed << ": " << (run.texts.empty() ? "" : run.texts.back());
    EXPECT_LE(run.T_docked_body.position().norm(), 0.02) << "seed " << seed;
    EXPECT_LE(std::abs(run.T_docked_body.yaw), kDegree) << "seed " << seed;
    worst_m = std::max(worst_m, run.T_docked_body.position().norm());
    worst_rad = std::max(worst_rad, std::abs(run.T_docked_body.yaw));
    worst_s = std::max(worst_s, run.time_s);
  }
  RecordProperty("worst_position_mm", std::to_string(1000.0 * worst_m));
  RecordProperty("worst_heading_deg", std::to_string(worst_rad / kDegree));
  EXPECT_LT(worst_s, 90.0);
}

// 0.06 degrees a second, more than minutes without a stop leave: docked at the first try all the same, within two
// centimetres.
TEST(Docking, AGyroBiasOfAThousandthOfARadianPerSecondDoesNotMakeItMiss) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    DockCase c{.T_docked_body = {-1.36, -0.03, 0.04}, .plant = {}, .odometry = {}, .seed = seed};
    c.odometry.turn_bias_radps = seed % 2 == 0 ? 0.001 : -0.001;
    const DockRun run = run_docking(c);
    EXPECT_EQ(run.status, DockingStatus::kDocked) << "seed " << seed;
    EXPECT_LE(run.T_docked_body.position().norm(), 0.02) << "seed " << seed;
    EXPECT_THAT(run.texts, ::testing::Not(::testing::Contains(::testing::HasSubstr("to retry")))) << "seed " << seed;
  }
}

TEST(Docking, NeverDrivesFartherThanTwoCentimetresPastTheDockedPose) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    EXPECT_LE(run_docking({.T_docked_body = {-1.3, 0.05, 0.1}, .plant = {}, .odometry = {}, .seed = seed}).farthest_m,
              0.02)
        << "seed " << seed;
  }
}

// Pushed 8 cm aside where the funnel is 5 cm wide: it backs up, drives in again and says so.
TEST(Docking, OffTheLineNearThePostBacksUpAndTriesAgain) {
  DockCase c{.T_docked_body = {-1.3, 0.0, 0.0}, .plant = {}, .odometry = {}};
  c.shove_at_s = 9.0;
  const DockRun run = run_docking(c);
  EXPECT_EQ(run.status, DockingStatus::kDocked);
  EXPECT_LE(run.T_docked_body.position().norm(), 0.02);
  EXPECT_THAT(run.texts, ::testing::Contains(::testing::HasSubstr("backing up to retry")));
}

TEST(Docking, StandsWhileThePostIsHiddenAndGoesOn) {
  DockCase c{.T_docked_body = {-1.3, 0.0, 0.0}, .plant = {}, .odometry = {}};
  c.hidden_from_s = 3.0;
  c.hidden_to_s = 9.0;
  const DockRun run = run_docking(c);
  EXPECT_EQ(run.status, DockingStatus::kDocked);
  EXPECT_GT(run.time_s, 9.0);
}

TEST(Docking, SaysThatThePostIsNotToBeSeen) {
  DockCase c{.T_docked_body = {-1.3, 0.0, 0.0}, .plant = {}, .odometry = {}};
  c.hidden_from_s = 0.0;
  const DockRun run = run_docking(c);
  EXPECT_EQ(run.status, DockingStatus::kFailed);
  EXPECT_NEAR(run.time_s, DockingSettings{}.detection_timeout_s, 0.2);
  EXPECT_EQ(run.texts.back(), "Docking failed: charging post not detected.");
  EXPECT_EQ(run.T_docked_body.x, -1.3);  // it has not moved blindly
}

TEST(Docking, UndockingIsStraightBackByTwelveDecimetres) {
  Docking docking({});
  TrackedPlant plant;
  docking.undock(Time{}, plant.T_map_body);
  DockingStep step;
  int tick = 0;
  for (; tick < 400 && step.status != DockingStatus::kFree; ++tick) {
    step = docking.step(from_seconds(tick * kPeriod_s), plant.T_map_body);
    plant.move(step.command, kPeriod_s);
  }
  EXPECT_EQ(step.status, DockingStatus::kFree);
  EXPECT_NEAR(plant.T_map_body.x, -1.2, 0.02);
  EXPECT_NEAR(plant.T_map_body.y, 0.0, 1e-9);
}

TEST(Docking, ReportsThatItDidNotGetOffThePostInTime) {
  Docking docking({});
  docking.undock(Time{}, {});
  docking.step(from_seconds(0.0), {});
  const DockingStep step = docking.step(from_seconds(DockingSettings{}.timeout_s + kPeriod_s), {});  // it has not moved
  EXPECT_EQ(step.status, DockingStatus::kFailed);
  EXPECT_EQ(step.text, "Undocking failed: timeout.");
  EXPECT_EQ(step.command.vx_mps, 0.0);
}

TEST(Docking, TheStagingPoseLiesStraightBeforeTheDock) {
  DockingSettings settings;
  settings.staging_distance_m = 1.5;
  const NavigationGoal goal = Docking(settings).staging_goal({2.0, 3.0, std::numbers::pi / 2.0});
  EXPECT_THAT(goal.T_map_body, test::Pose2Near(Pose2{2.0, 1.5, std::numbers::pi / 2.0}, 1e-12, 1e-12));
}

TEST(Docking, IdleItStandsAndHeedsNoSighting) {
  Docking docking({});
  docking.add({.stamp = from_seconds(1.0), .T_level_docked = {1.0, 0.0, 0.0}}, {});
  const DockingStep step = docking.step(from_seconds(1.0), {});
  EXPECT_EQ(step.status, DockingStatus::kIdle);
  EXPECT_EQ(step.command.vx_mps, 0.0);
  EXPECT_FALSE(docking.T_level_docked({}));
}

TEST(Docking, RefusesSettingsThatBreakTheirRule) {
  DockingSettings settings;
  settings.max_attempts = 0;
  EXPECT_THAT([&] { Docking{settings}; },
              ::testing::ThrowsMessage<InputError>(::testing::HasSubstr("docking.max_attempts = 0")));
}

}  // namespace
}  // namespace patrol::plan::docking_test
