#include "render/film/run_history.h"

#include <gtest/gtest.h>

#include "io/logs/run_log.h"
#include "tests/render/small_scene.h"
#include "tests/support/temporary_file.h"

namespace patrol::render::run_history_test {
namespace {

using namespace std::chrono_literals;

constexpr const char* kRobotAndWalker = R"(
  <body name="base_link" pos="0 0 0.3"><freejoint/><geom type="box" size="0.3 0.15 0.1" group="4"/></body>
  <body name="walker" pos="1 0 0.3" mocap="true"><geom type="sphere" size="0.2"/></body>)";

TEST(RunHistory, IsWhatTheLogTellsOfTheWholeRun) {
  const test::TemporaryFolder folder;
  const sim::ModelPtr model = small_scene(kRobotAndWalker);
  io::RunLogWriter log(folder / "log.mcap", RobotDescription{});
  for (Time now = 20ms; now <= 1s; now += 20ms) {
    log.write(now, GroundTruth{now, {{5.0, 2.0, 0.3}, Eigen::Quaterniond::Identity()}, {}});
    log.write(now, PoseEstimate{now, {1.0, 0.25, 0.0}, Eigen::Matrix3d::Zero()});
    SimState state = reference_state(*model);
    state.stamp = now;
    log.write(now, state);
  }
  log.write(1s, Collision{1s, "trunk", "wall"});
  log.write(1s, Event{.stamp = 1s,
                      .kind = EventKind::kDocked,
                      .subject = "",
                      .text = "Docked.",
                      .value = 0.0,
                      .T_map_body = {},
                      .p_map_target = {}});
  log.close();
  const RunHistory history = read_run_history(folder / "log.mcap", *model, {4.0, 2.0, 0.0});
  EXPECT_EQ(history.num_states, 50);
  EXPECT_EQ(history.begin, Time(20ms));
  EXPECT_EQ(history.end, Time(1s));
  ASSERT_EQ(history.errors.size(), 50u);
  EXPECT_NEAR((history.errors[7].error_in_world_m - Eigen::Vector2d(0.0, 0.25)).norm(), 0.0,
              1e-9);  // (4, 2) + (1, 0.25) - (5, 2)
  ASSERT_EQ(history.approaches.size(), 10u) << "ten a second";
  EXPECT_NEAR(history.approaches[3].clearance_m, 1.0 - 0.3 - 0.2, 1e-3);
  EXPECT_EQ(history.collisions.size(), 1u);
  EXPECT_EQ(history.events.size(), 1u);
}

}  // namespace
}  // namespace patrol::render::run_history_test
