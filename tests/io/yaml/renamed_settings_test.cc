#include "io/yaml/renamed_settings.h"

#include <gtest/gtest.h>

namespace patrol::io::renamed_settings_test {
namespace {

TEST(RenamedSettings, SectionsAndKeysBelowThemAreRenamedTogether) {
  EXPECT_EQ(renamed_setting("stack.plan"), "stack.navigation");
  EXPECT_EQ(renamed_setting("stack.plan.costmap"), "stack.navigation.costmap");
}

TEST(RenamedSettings, KeysOfListEntriesAreRenamed) {
  EXPECT_EQ(renamed_setting("props.3"), "static_obstacles.3");
  EXPECT_EQ(renamed_setting("props.3.turn_deg"), "static_obstacles.3.yaw_deg");
}

TEST(RenamedSettings, KeysOfSeveralSensorsAreRenamedInEach) {
  EXPECT_EQ(renamed_setting("sensors.lidar3d.range_noise_m"), "sensors.lidar3d.range_noise_std_m");
  EXPECT_EQ(renamed_setting("sensors.uwb.range_noise_m"), "sensors.uwb.range_noise_std_m");
  EXPECT_EQ(renamed_setting("remote.driver.meets_robot"), "teleop.operator.wait_for_robot");
}

TEST(RenamedSettings, SlamKeysAreRenamedBelowEveryRoot) {
  EXPECT_EQ(renamed_setting("stack.slam.graph.tracking.likelihood_gain"),
            "stack.slam.graph.scan_odometry.likelihood_tempering");
  EXPECT_EQ(renamed_setting("slam.graph.loops.ambiguity"), "slam.graph.loop_closure.max_second_best_ratio");
  EXPECT_EQ(renamed_setting("submap_rbpf.joints.rival_share"), "submap_rbpf.constraints.max_second_best_ratio");
  EXPECT_EQ(renamed_setting("stretches.tracking.matching.min_matched_share"),
            "segments.scan_odometry.matching.min_inlier_ratio");
  EXPECT_EQ(renamed_setting("turn_scale"), "rotation_scale");
  EXPECT_EQ(renamed_setting("calibration.turn_scale"), "calibration.rotation_scale");
}

TEST(RenamedSettings, ParticleFilterAndLeggedOdometryMoveOneLevelDown) {
  EXPECT_EQ(renamed_setting("stack.slam.motion.across_std_m_per_m"), "stack.slam.rbpf.motion.lateral_std_m_per_m");
  EXPECT_EQ(renamed_setting("stack.slam.rbpf.particles"), "stack.slam.rbpf.particles");
  EXPECT_EQ(renamed_setting("stack.odometry.touch_force_n"), "stack.odometry.legged.contact_on_force_n");
}

TEST(RenamedSettings, KeysMoveBetweenSections) {
  EXPECT_EQ(renamed_setting("stack.plan.recoveries"), "stack.navigation.recovery.behaviors");
  EXPECT_EQ(renamed_setting("stack.plan.paper_local.target_ahead_m"),
            "stack.navigation.local_planner.dwa_liu21.lookahead_m");
  EXPECT_EQ(renamed_setting("stack.dock_detector.range_std_m"), "stack.docking.detector.range_std_m");
  EXPECT_EQ(renamed_setting("routes.two_swarms.own_pull"), "routes.dual_swarm_pso.cognitive_weight");
}

// The old selector has the name of a section of today.
TEST(RenamedSettings, ASelectorDiffersFromTheSectionOfItsOldName) {
  EXPECT_EQ(renamed_setting("stack.plan.local_planner"), "stack.navigation.local_planner.method");
  EXPECT_EQ(renamed_setting("stack.navigation.local_planner.dwa"), "stack.navigation.local_planner.dwa");
}

TEST(RenamedSettings, KeysThatKeepTheirNameAreReturnedUnchanged) {
  EXPECT_EQ(renamed_setting("stack.navigation.costmap"), "stack.navigation.costmap");
  EXPECT_EQ(renamed_setting("planner"), "planner");
  EXPECT_EQ(renamed_setting(""), "");
}

}  // namespace
}  // namespace patrol::io::renamed_settings_test
