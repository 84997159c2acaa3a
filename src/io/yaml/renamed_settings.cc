#include "io/yaml/renamed_settings.h"

#include <algorithm>
#include <array>

namespace patrol::io {
namespace {

struct RenamedKey {
  std::string_view before;  ///< path with its parents as they are today; a leading `*` stands for any parents
  std::string_view now;     ///< full path, or `*` with the same parents
};

constexpr auto kRenamed = std::to_array<RenamedKey>({
    // Sensors, robot and world.

    // Scenario.

    // Stack: odometry and localization.

    // Stack: SLAM; patrol slam, calibrate, train-neighbors.

    // Stack: navigation and docking; patrol plan.
    {"stack.plan", "stack.navigation"},
    {"stack.navigation.drive", "stack.navigation.kinematics"},
    {"stack.navigation.global", "stack.navigation.global_planner.method"},
    {"stack.navigation.routes", "stack.navigation.global_planner"},
    {"stack.navigation.global_planner.kept_clearance_m", "stack.navigation.global_planner.min_clearance_m"},
    {"stack.plan.local_planner", "stack.navigation.local_planner.method"},  // old parents: the section has this name
    {"stack.navigation.local", "stack.navigation.local_planner.dwa"},
    {"stack.navigation.paper_local", "stack.navigation.local_planner.dwa_liu21"},
    {"stack.navigation.local_planner.dwa.change_weight", "stack.navigation.local_planner.dwa.command_change_weight"},
    {"stack.navigation.local_planner.dwa.max_accel_mps2", "stack.navigation.local_planner.dwa.max_acceleration_mps2"},
    {"stack.navigation.local_planner.dwa.max_yaw_accel_radps2",
     "stack.navigation.local_planner.dwa.max_yaw_acceleration_radps2"},
    {"stack.navigation.local_planner.dwa_liu21.max_accel_mps2",
     "stack.navigation.local_planner.dwa_liu21.max_acceleration_mps2"},
    {"stack.navigation.local_planner.dwa_liu21.max_decel_mps2",
     "stack.navigation.local_planner.dwa_liu21.max_deceleration_mps2"},
    {"stack.navigation.local_planner.dwa_liu21.max_yaw_accel_radps2",
     "stack.navigation.local_planner.dwa_liu21.max_yaw_acceleration_radps2"},
    {"stack.navigation.local_planner.dwa_liu21.max_yaw_decel_radps2",
     "stack.navigation.local_planner.dwa_liu21.max_yaw_deceleration_radps2"},
    {"stack.navigation.local_planner.dwa_liu21.target_ahead_m",
     "stack.navigation.local_planner.dwa_liu21.lookahead_m"},
    {"stack.navigation.approach", "stack.navigation.goal_controller.holonomic"},
    {"stack.navigation.goal_controller.holonomic.max_side_speed_mps",
     "stack.navigation.goal_controller.holonomic.max_lateral_speed_mps"},
    {"stack.navigation.differential_approach", "stack.navigation.goal_controller.differential"},
    {"stack.navigation.goal_controller.differential.aim_share",
     "stack.navigation.goal_controller.differential.tolerance_fraction"},
    {"stack.navigation.goal_controller.differential.reverse_m",
     "stack.navigation.goal_controller.differential.max_reverse_distance_m"},
    {"stack.navigation.goal_controller.differential.shuffle_m",
     "stack.navigation.goal_controller.differential.lateral_correction_distance_m"},
    {"*.line.side_gain_per_m", "*.line.lateral_gain_per_m"},
    {"stack.navigation.steps_per_s", "stack.navigation.planner_cells_per_s"},
    {"stack.navigation.check_ahead_m", "stack.navigation.path_check_distance_m"},
    {"stack.navigation.stray_m", "stack.navigation.max_path_deviation_m"},
    {"stack.navigation.approach_m", "stack.navigation.goal_approach_distance_m"},
    {"stack.navigation.approach_decel_mps2", "stack.navigation.approach_deceleration_mps2"},
    {"stack.navigation.turn_first_rad", "stack.navigation.turn_in_place_threshold_rad"},
    {"stack.navigation.turn_rate_radps", "stack.navigation.turn_in_place_rate_radps"},
    {"stack.navigation.patience_s", "stack.navigation.blocked_timeout_s"},
    {"stack.navigation.stuck_s", "stack.navigation.no_progress_timeout_s"},
    {"stack.navigation.no_route_s", "stack.navigation.no_path_timeout_s"},
    {"stack.navigation.detour_after_s", "stack.navigation.new_obstacle_wait_s"},
    {"stack.navigation.newcomer_distance_m", "stack.navigation.unmapped_obstacle_slowdown_distance_m"},
    {"stack.navigation.newcomer_speed_mps", "stack.navigation.unmapped_obstacle_max_speed_mps"},
    {"stack.navigation.recoveries", "stack.navigation.recovery.behaviors"},
    {"stack.navigation.max_recoveries", "stack.navigation.recovery.max_attempts"},
    {"stack.navigation.back_up_s", "stack.navigation.recovery.back_up_duration_s"},
    {"stack.navigation.back_up_speed_mps", "stack.navigation.recovery.back_up_speed_mps"},
    {"*.crosses_unknown", "*.allow_unknown"},
    {"*.obstacle_memory_s", "*.obstacle_persistence_s"},
    {"*.map_slack_cells", "*.map_match_tolerance_cells"},
    {"*.low.memory_s", "*.low.persistence_s"},
    {"*.low.moving_memory_s", "*.low.dynamic_persistence_s"},
    {"*.low.sonar_memory_s", "*.low.sonar_persistence_s"},
    {"*.low.camera_veto_s", "*.low.camera_clearing_s"},
    {"stack.navigation.depth", "stack.navigation.depth_obstacles"},
    {"stack.navigation.depth_obstacles.clear_range_m", "stack.navigation.depth_obstacles.clearing_range_m"},
    {"stack.navigation.depth_obstacles.rows_below", "stack.navigation.depth_obstacles.ground_search_rows"},
    {"stack.navigation.sonar", "stack.navigation.sonar_obstacles"},
    {"stack.navigation.sonar_obstacles.fov_share", "stack.navigation.sonar_obstacles.fov_fraction"},
    {"stack.navigation.sonar_obstacles.ground_share", "stack.navigation.sonar_obstacles.ground_range_fraction"},
    {"*.ant_colony.splices", "*.ant_colony.remove_loops"},
    {"*.improved_colony.tightens", "*.improved_colony.shorten_paths"},
    {"*.two_swarms", "*.dual_swarm_pso"},
    {"*.dual_swarm_pso.own_pull", "*.dual_swarm_pso.cognitive_weight"},
    {"*.dual_swarm_pso.swarm_pull", "*.dual_swarm_pso.social_weight"},
    {"*.dual_swarm_pso.exchange_iterations", "*.dual_swarm_pso.exchange_period"},
    {"*.q_learning.max_steps_share", "*.q_learning.max_steps_per_cell"},
    {"stack.dock_detector", "stack.docking.detector"},
    {"stack.docking.staging_m", "stack.docking.staging_distance_m"},
    {"stack.docking.staging_tol_m", "stack.docking.staging_tolerance_m"},
    {"stack.docking.staging_tol_rad", "stack.docking.staging_tolerance_rad"},
    {"stack.docking.funnel_m", "stack.docking.corridor_half_width_m"},
    {"stack.docking.funnel_m_per_m", "stack.docking.corridor_slope"},
    {"stack.docking.square_up_m", "stack.docking.heading_blend_distance_m"},
    {"stack.docking.position_tol_m", "stack.docking.position_tolerance_m"},
    {"stack.docking.yaw_tol_rad", "stack.docking.yaw_tolerance_rad"},
    {"stack.docking.settle_s", "stack.docking.settling_time_s"},
    {"stack.docking.min_sightings", "stack.docking.min_detections"},
    {"stack.docking.max_blind_s", "stack.docking.max_detection_gap_s"},
    {"stack.docking.give_up_blind_s", "stack.docking.detection_timeout_s"},
    {"stack.docking.max_tries", "stack.docking.max_attempts"},
    {"stack.docking.time_limit_s", "stack.docking.timeout_s"},
    {"stack.docking.undock_m", "stack.docking.undock_distance_m"},
    {"stack.docking.track", "stack.docking.pose_filter"},
    {"stack.docking.pose_filter.way_std_m_per_m", "stack.docking.pose_filter.position_std_m_per_m"},
    {"stack.docking.pose_filter.turn_std_rad_per_rad", "stack.docking.pose_filter.yaw_std_rad_per_rad"},
    {"stack.docking.pose_filter.turn_std_rad_per_m", "stack.docking.pose_filter.yaw_std_rad_per_m"},
    {"stack.docking.pose_filter.turn_std_rad_per_sqrt_s", "stack.docking.pose_filter.yaw_random_walk_rad_per_sqrt_s"},
    {"stack.docking.pose_filter.side_std_m_per_rad", "stack.docking.pose_filter.lateral_std_m_per_rad"},
    {"stack.docking.pose_filter.least_std_m", "stack.docking.pose_filter.min_std_m"},
    {"stack.docking.pose_filter.least_std_rad", "stack.docking.pose_filter.min_std_rad"},

    // Stack: missions and inspection; sections of the stack.
    {"stack.settle_s", "stack.odometry_settling_time_s"},
    {"stack.track_odometry", "stack.odometry.tracked"},
    {"stack.leveling", "stack.scan_leveling"},
    {"stack.mapping", "stack.slam.method"},
    {"stack.graph", "stack.slam.graph"},
    {"stack.submap_rbpf", "stack.slam.submap_rbpf"},
    {"stack.range_filter", "stack.uwb_filter"},
    {"stack.sensor_watch", "stack.sensor_monitor"},
    {"stack.sensor_monitor.lidar_age_s", "stack.sensor_monitor.lidar_timeout_s"},
    {"stack.sensor_monitor.motion_age_s", "stack.sensor_monitor.proprioception_timeout_s"},
    {"stack.sensor_monitor.instrument_age_s", "stack.sensor_monitor.instrument_timeout_s"},
    {"stack.sensor_monitor.future_s", "stack.sensor_monitor.max_clock_lead_s"},
    {"stack.sensor_monitor.give_up_s", "stack.sensor_monitor.abort_timeout_s"},
    {"stack.mission", "stack.gas_mission"},
    {"stack.gas_mission.order", "stack.gas_mission.station_order"},
    {"stack.gas_mission.start_wait_s", "stack.gas_mission.init_wait_s"},
    {"stack.gas_mission.settle_s", "stack.gas_mission.settling_time_s"},
    {"stack.gas_mission.measure_s", "stack.gas_mission.measurement_duration_s"},
    {"stack.gas_mission.max_measure_s", "stack.gas_mission.measurement_timeout_s"},
    {"stack.gas_mission.position_tol_m", "stack.gas_mission.position_tolerance_m"},
    {"stack.gas_mission.yaw_tol_rad", "stack.gas_mission.yaw_tolerance_rad"},
    {"stack.tour", "stack.tunnel_mission"},
    {"stack.tunnel_mission.navigations", "stack.tunnel_mission.num_runs"},
    {"stack.tunnel_mission.starts_docked", "stack.tunnel_mission.start_docked"},
    {"stack.tunnel_mission.starts_at_survey", "stack.tunnel_mission.start_at_survey"},
    {"stack.tunnel_mission.docks", "stack.tunnel_mission.dock_after_run"},
    {"stack.tunnel_mission.start_wait_s", "stack.tunnel_mission.init_wait_s"},
    {"stack.tunnel_mission.start_look_s", "stack.tunnel_mission.first_scan_wait_s"},
    {"stack.tunnel_mission.stand_s", "stack.tunnel_mission.dwell_s"},
    {"stack.tunnel_mission.position_tol_m", "stack.tunnel_mission.position_tolerance_m"},
    {"stack.tunnel_mission.yaw_tol_rad", "stack.tunnel_mission.yaw_tolerance_rad"},
    {"stack.tunnel_mission.remote_silence_s", "stack.tunnel_mission.teleop_timeout_s"},
    {"stack.tunnel_mission.lost_patience_s", "stack.tunnel_mission.relocalization_timeout_s"},
    {"stack.tunnel_mission.mark_types", "stack.tunnel_mission.goal_types"},
    {"stack.tunnel_mission.driver_patience_s", "stack.tunnel_mission.operator_timeout_s"},
    {"stack.inspection.scan_settle_s", "stack.inspection.scan_settling_time_s"},
    {"stack.inspection.scan_patience_s", "stack.inspection.scan_timeout_s"},
    {"stack.inspection.siren_s", "stack.inspection.siren_duration_s"},
    {"stack.inspection.lining.near_m", "stack.inspection.lining.min_range_m"},
    {"stack.inspection.lining.reach_m", "stack.inspection.lining.comparison_range_m"},
    {"stack.inspection.lining.band_m", "stack.inspection.lining.design_tolerance_m"},
    {"stack.inspection.lining.guess_std_m", "stack.inspection.lining.prior_std_m"},
    {"stack.inspection.lining.guess_std_deg", "stack.inspection.lining.prior_std_deg"},
    {"stack.inspection.lining.min_share", "stack.inspection.lining.min_inlier_ratio"},
    {"stack.inspection.lining.min_grip_share", "stack.inspection.lining.min_axial_overlap"},
    {"stack.inspection.lining.registration.first_distance_m",
     "stack.inspection.lining.registration.initial_pair_distance_m"},
    {"stack.inspection.lining.registration.last_distance_m",
     "stack.inspection.lining.registration.final_pair_distance_m"},
    {"stack.inspection.lining.registration.step_tol_m", "stack.inspection.lining.registration.step_tolerance_m"},
    {"stack.inspection.water.moves", "stack.inspection.water.mcmc_steps"},
    {"stack.inspection.water.errors.steel_rate", "stack.inspection.water.errors.steel_response"},
    {"stack.inspection.water.sounding.settled_deg", "stack.inspection.water.sounding.settled_tolerance_deg"},
    {"stack.inspection.water.sounding.settle_s", "stack.inspection.water.sounding.settling_time_s"},
    {"stack.inspection.water.sounding.turn_timeout_s", "stack.inspection.water.sounding.orientation_timeout_s"},
    {"stack.inspection.water.sounding.give_up_after", "stack.inspection.water.sounding.max_consecutive_failures"},

    // Monitor.
});

/// Returns the present path of a key whose parents carry their present names.
std::string rename_last(const std::string& path) {
  for (const RenamedKey& key : kRenamed) {
    if (key.before == path) return std::string(key.now);
    if (key.before.starts_with("*.") && path.ends_with(key.before.substr(1))) {
      return path.substr(0, path.size() - key.before.size() + 1) + std::string(key.now.substr(1));
    }
  }
  return path;
}

}  // namespace

// A row with the old parents precedes: there, a key of the same name with another meaning exists today.
std::string renamed_setting(std::string_view path) {
  std::string renamed;
  for (std::size_t begin = 0; begin < path.size();) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    const std::string_view before = path.substr(0, end);
    const auto is_before = [&](const RenamedKey& key) { return key.before == before; };
    const auto row = std::find_if(kRenamed.begin(), kRenamed.end(), is_before);
    if (row != kRenamed.end()) {
      renamed = row->now;
    } else {
      renamed = rename_last((renamed.empty() ? "" : renamed + ".") + std::string(path.substr(begin, end - begin)));
    }
    begin = std::min(end + 1, path.size());
  }
  return renamed;
}

}  // namespace patrol::io
