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
    // The legged odometry moves from stack.odometry to stack.odometry.legged.
    {"stack.odometry.gyro_noise_radps_per_sqrt_hz", "stack.odometry.legged.gyro_noise_density_radps_per_sqrt_hz"},
    {"stack.odometry.gyro_bias_std_radps", "stack.odometry.legged.gyro_bias_std_radps"},
    {"stack.odometry.gyro_bias_walk_radps_per_sqrt_s", "stack.odometry.legged.gyro_bias_random_walk_radps_per_sqrt_s"},
    {"stack.odometry.accel_noise_mps2_per_sqrt_hz", "stack.odometry.legged.accel_noise_density_mps2_per_sqrt_hz"},
    {"stack.odometry.accel_bias_std_mps2", "stack.odometry.legged.accel_bias_std_mps2"},
    {"stack.odometry.accel_bias_walk_mps2_per_sqrt_s", "stack.odometry.legged.accel_bias_random_walk_mps2_per_sqrt_s"},
    {"stack.odometry.touch_force_n", "stack.odometry.legged.contact_on_force_n"},
    {"stack.odometry.release_force_n", "stack.odometry.legged.contact_off_force_n"},
    {"stack.odometry.full_force_n", "stack.odometry.legged.full_weight_force_n"},
    {"stack.odometry.contact_settle_s", "stack.odometry.legged.contact_settling_time_s"},
    {"stack.odometry.foot_velocity_std_mps", "stack.odometry.legged.foot_velocity_std_mps"},
    {"stack.odometry.slip_speed_mps", "stack.odometry.legged.slip_speed_mps"},
    {"stack.odometry.geometric_stance_m", "stack.odometry.legged.stance_height_tolerance_m"},
    {"stack.odometry.standstill_window_s", "stack.odometry.legged.standstill_window_s"},
    {"stack.odometry.standstill_foot_std_m", "stack.odometry.legged.standstill_foot_std_m"},
    {"stack.odometry.way_std_m_per_sqrt_m", "stack.odometry.legged.position_random_walk_m_per_sqrt_m"},
    {"stack.odometry.turn_std_rad_per_sqrt_rad", "stack.odometry.legged.yaw_random_walk_rad_per_sqrt_rad"},
    {"stack.odometry.imu_patience_s", "stack.odometry.legged.imu_timeout_s"},
    {"stack.odometry.history_s", "stack.odometry.legged.buffer_s"},
    {"stack.odometry.extrapolation_s", "stack.odometry.legged.max_extrapolation_s"},
    {"stack.odometry.tracked.gyro_noise_radps_per_sqrt_hz",
     "stack.odometry.tracked.gyro_noise_density_radps_per_sqrt_hz"},
    {"stack.odometry.tracked.gyro_bias_walk_radps_per_sqrt_s",
     "stack.odometry.tracked.gyro_bias_random_walk_radps_per_sqrt_s"},
    {"stack.odometry.tracked.accel_noise_mps2_per_sqrt_hz",
     "stack.odometry.tracked.accel_noise_density_mps2_per_sqrt_hz"},
    {"stack.odometry.tracked.accel_bias_walk_mps2_per_sqrt_s",
     "stack.odometry.tracked.accel_bias_random_walk_mps2_per_sqrt_s"},
    {"stack.odometry.tracked.turn_std_rad_per_sqrt_rad", "stack.odometry.tracked.yaw_random_walk_rad_per_sqrt_rad"},
    {"stack.odometry.tracked.turn_ratio", "stack.odometry.tracked.skid_ratio"},
    {"stack.odometry.tracked.slip_length_m", "stack.odometry.tracked.slip_correlation_m"},
    {"stack.odometry.tracked.turn_centre_x_std_m", "stack.odometry.tracked.icr_x_std_m"},
    {"stack.odometry.tracked.turn_centre_y_std_m", "stack.odometry.tracked.icr_y_std_m"},
    {"stack.odometry.tracked.turn_centre_length_rad", "stack.odometry.tracked.icr_correlation_rad"},
    {"stack.odometry.tracked.settle_s", "stack.odometry.tracked.settling_time_s"},
    {"stack.odometry.tracked.start_patience_s", "stack.odometry.tracked.init_timeout_s"},
    {"stack.odometry.tracked.imu_patience_s", "stack.odometry.tracked.imu_timeout_s"},
    {"stack.odometry.tracked.max_belt_acceleration_mps2", "stack.odometry.tracked.max_track_acceleration_mps2"},
    {"stack.odometry.tracked.history_s", "stack.odometry.tracked.buffer_s"},
    {"stack.odometry.tracked.extrapolation_s", "stack.odometry.tracked.max_extrapolation_s"},
    {"stack.scan_leveling.self_radius_m", "stack.scan_leveling.self_filter_radius_m"},
    {"*.no_return_free_m", "*.no_return_clearing_range_m"},
    {"stack.scan_leveling.stabilized", "stack.scan_leveling.gimbal_stabilized"},
    {"stack.uwb_filter.blocked_share", "stack.uwb_filter.nlos_probability"},
    {"stack.uwb_filter.blocked_excess_m", "stack.uwb_filter.nlos_bias_m"},
    {"stack.uwb_filter.min_clear_probability", "stack.uwb_filter.min_los_probability"},
    {"stack.uwb_filter.max_short_sigmas", "stack.uwb_filter.negative_gate_sigma"},
    {"stack.uwb_filter.along_length_m", "stack.uwb_filter.longitudinal_correlation_m"},
    {"stack.uwb_filter.across_length_m", "stack.uwb_filter.lateral_correlation_m"},
    {"stack.uwb_filter.turn_time_s", "stack.uwb_filter.yaw_correlation_s"},
    {"stack.uwb_filter.way_std_m_per_sqrt_m", "stack.uwb_filter.position_random_walk_m_per_sqrt_m"},
    {"stack.uwb_filter.turn_std_rad_per_sqrt_s", "stack.uwb_filter.yaw_random_walk_rad_per_sqrt_s"},
    {"stack.uwb_filter.turn_std_rad_per_sqrt_rad", "stack.uwb_filter.yaw_random_walk_rad_per_sqrt_rad"},
    {"stack.uwb_filter.min_accepted_share", "stack.uwb_filter.min_accepted_ratio"},
    {"stack.uwb_filter.doubt_std_m", "stack.uwb_filter.reset_std_m"},
    {"stack.uwb_filter.doubt_std_rad", "stack.uwb_filter.reset_std_rad"},
    {"*.min_explained", "*.min_inlier_ratio"},
    {"*.margin_m", "*.end_clearance_m"},
    {"stack.localization.independent_beams", "stack.localization.effective_beams"},
    {"stack.localization.scan_fit_tol", "stack.localization.scan_fit_tolerance"},
    {"stack.localization.min_particles_when_lost", "stack.localization.min_particles_lost"},
    {"stack.localization.range_memory_s", "stack.localization.range_buffer_s"},
    {"stack.localization.odometry.way_scale_std", "stack.localization.odometry.scale_std"},
    {"stack.localization.odometry.way_scale_memory_m", "stack.localization.odometry.scale_correlation_length_m"},
    {"*.noise.turn_std_rad_per_rad", "*.noise.yaw_std_rad_per_rad"},
    {"*.noise.turn_std_rad_per_m", "*.noise.yaw_std_rad_per_m"},
    {"*.noise.turn_std_rad_per_s", "*.noise.yaw_std_rad_per_s"},
    {"*.random_share", "*.z_rand"},
    {"*.hit_share", "*.z_hit"},
    {"*.short_share", "*.z_short"},
    {"*.max_share", "*.z_max"},
    {"stack.localization.kld.max_error", "stack.localization.kld.max_kl_divergence"},
    {"stack.localization.kld.quantile", "stack.localization.kld.normal_quantile"},
    {"stack.localization.ranges.blocked_share", "stack.localization.ranges.nlos_probability"},
    {"stack.localization.ranges.blocked_excess_m", "stack.localization.ranges.nlos_bias_m"},
    {"stack.localization.ranges.outlier_share", "stack.localization.ranges.outlier_probability"},
    {"stack.localization.refinement", "stack.localization.scan_refinement"},
    {"stack.localization.scan_refinement.min_facing", "stack.localization.scan_refinement.min_incidence_sine"},
    {"stack.localization.search", "stack.localization.global_localization"},
    {"stack.localization.fit", "stack.localization.divergence_monitor"},
    {"stack.localization.divergence_monitor.slow_rate", "stack.localization.divergence_monitor.alpha_slow"},
    {"stack.localization.divergence_monitor.fast_rate", "stack.localization.divergence_monitor.alpha_fast"},
    {"stack.localization.divergence_monitor.range_rate", "stack.localization.divergence_monitor.alpha_range"},
    {"stack.localization.divergence_monitor.max_injection",
     "stack.localization.divergence_monitor.max_injection_fraction"},
    {"stack.localization.trust", "stack.localization.confidence"},
    {"stack.localization.confidence.sure_std_m", "stack.localization.confidence.std_at_confidence_1_m"},
    {"stack.localization.confidence.doubtful_std_m", "stack.localization.confidence.std_at_confidence_half_m"},
    {"stack.localization.confidence.hopeless_std_m", "stack.localization.confidence.std_at_confidence_0_m"},
    {"stack.localization.confidence.good_fit", "stack.localization.confidence.full_confidence_fit"},
    {"stack.localization.confidence.bad_fit", "stack.localization.confidence.zero_confidence_fit"},
    {"stack.localization.confidence.decided_weight", "stack.localization.confidence.full_confidence_cluster_weight"},
    {"stack.localization.confidence.undecided_weight", "stack.localization.confidence.zero_confidence_cluster_weight"},
    {"stack.localization.confidence.lost_below", "stack.localization.confidence.lost_threshold"},
    {"stack.localization.confidence.found_above", "stack.localization.confidence.found_threshold"},

    // Stack: SLAM; patrol slam, calibrate, train-neighbors.
    // The particle filter moves from stack.slam to stack.slam.rbpf.
    {"stack.slam.resolution_m", "stack.slam.rbpf.resolution_m"},
    {"stack.slam.max_extent_m", "stack.slam.rbpf.max_extent_m"},
    {"stack.slam.min_hits_occupied", "stack.slam.rbpf.min_hits_occupied"},
    {"stack.slam.keyframe_distance_m", "stack.slam.rbpf.keyframe_distance_m"},
    {"stack.slam.keyframe_angle_rad", "stack.slam.rbpf.keyframe_angle_rad"},
    {"stack.slam.max_tilt_rad", "stack.slam.rbpf.max_tilt_rad"},
    {"stack.slam.initial_keyframes", "stack.slam.rbpf.initial_keyframes"},
    {"stack.slam.particles", "stack.slam.rbpf.particles"},
    {"stack.slam.proposal", "stack.slam.rbpf.proposal"},
    {"stack.slam.optimizer", "stack.slam.rbpf.optimizer"},
    {"stack.slam.resample_threshold", "stack.slam.rbpf.resample_threshold"},
    {"stack.slam.motion", "stack.slam.rbpf.motion"},
    {"stack.slam.ranges", "stack.slam.rbpf.ranges"},
    {"stack.slam.matching", "stack.slam.rbpf.matching"},
    {"stack.slam.integration", "stack.slam.rbpf.integration"},
    {"stack.slam.odometry", "stack.slam.rbpf.odometry"},
    {"stack.slam.tracking", "stack.slam.rbpf.scan_odometry"},
    {"stack.slam.likelihood_gain", "stack.slam.rbpf.likelihood_tempering"},
    {"stack.slam.min_hit_share_occupied", "stack.slam.rbpf.min_occupied_hit_ratio"},
    // The same settings below `stack.slam` of a scenario, `slam` of patrol slam, `submap_rbpf` of patrol train-neighbors
    // and `segments` of patrol calibrate.
    {"*.tracking", "*.scan_odometry"},
    {"*.likelihood_gain", "*.likelihood_tempering"},
    {"*.min_hit_share_occupied", "*.min_occupied_hit_ratio"},
    {"*.min_matched_share", "*.min_inlier_ratio"},
    {"*.along_std_m_per_m", "*.longitudinal_std_m_per_m"},
    {"*.across_std_m_per_m", "*.lateral_std_m_per_m"},
    {"*.motion.turn_std_rad_per_rad", "*.motion.yaw_std_rad_per_rad"},
    {"*.motion.turn_std_rad_per_m", "*.motion.yaw_std_rad_per_m"},
    {"*.motion.turn_std_rad_per_s", "*.motion.yaw_std_rad_per_s"},
    {"*.gate_std", "*.gate_sigma"},
    {"*.gate_excess_std", "*.nlos_gate_sigma"},
    {"*.graph.loops", "*.graph.loop_closure"},
    {"*.min_known_share", "*.min_overlap_ratio"},
    {"*.ambiguity", "*.max_second_best_ratio"},
    {"*.ambiguity_distance_m", "*.min_second_best_distance_m"},
    {"*.ambiguity_angle_rad", "*.min_second_best_angle_rad"},
    {"*.solver.doubts_loops", "*.solver.robust_loop_closures"},
    {"*.solver.loop_kernel", "*.solver.loop_closure_loss_scale"},
    {"*.graph.open_share", "*.graph.min_eigenvalue_ratio"},
    {"*.graph.refinement_rounds", "*.graph.refinement_iterations"},
    {"*.graph.min_refinement_share", "*.graph.min_refinement_inlier_ratio"},
    {"*.graph.redraw_shift_m", "*.graph.map_update_threshold_m"},
    {"*.graph.range_keyframes", "*.graph.range_smoothing_period_keyframes"},
    {"*.submaps.max_way_m", "*.submaps.max_distance_m"},
    {"*.surfaces.shape", "*.surfaces.descriptor"},
    {"*.descriptor.seen_cell_m", "*.descriptor.observed_cell_m"},
    {"*.ndt.step_tol_per_cell", "*.ndt.step_tolerance_per_cell"},
    {"*.surfaces.facing_radius_m", "*.surfaces.free_space_radius_m"},
    {"*.icp.use_effective_neighbours", "*.icp.use_effective_neighbors"},
    {"*.icp.refine_on_lines", "*.icp.point_to_line"},
    {"*.icp.step_tol_m", "*.icp.step_tolerance_m"},
    {"*.joints", "*.constraints"},
    {"*.constraints.min_agreement", "*.constraints.min_overlap_consistency"},
    {"*.constraints.rival_share", "*.constraints.max_second_best_ratio"},
    {"*.constraints.rival_distance_m", "*.constraints.min_second_best_distance_m"},
    {"*.constraints.rival_angle_rad", "*.constraints.min_second_best_angle_rad"},
    {"*.joint_gain", "*.likelihood_tempering"},
    {"*.joint_std_m", "*.constraint_std_m"},
    {"*.joint_std_rad", "*.constraint_std_rad"},
    {"examples.blunder_share", "examples.outlier_probability"},
    {"log.skip_bad_lines", "log.skip_invalid"},
    {"log.finds_no_return", "log.detect_no_return"},
    {"stretches", "segments"},
    {"segments.stretch_m", "segments.length_m"},
    {"segments.stretch_rad", "segments.rotation_rad"},
    {"calibrator.min_stretches", "calibrator.min_segments"},
    {"calibrator.odometry.turn_std_rad_per_rad", "calibrator.odometry.yaw_std_rad_per_rad"},
    {"calibrator.odometry.turn_std_rad_per_m", "calibrator.odometry.yaw_std_rad_per_m"},
    {"calibrator.odometry.turn_std_rad_per_s", "calibrator.odometry.yaw_std_rad_per_s"},
    {"calibrator.outlier_std", "calibrator.outlier_sigma"},
    {"calibrator.max_std_turn_scale", "calibrator.max_std_rotation_scale"},
    {"calibrator.max_std_steering_rad_per_m", "calibrator.max_std_steering_bias_rad_per_m"},
    // Keys of calibration.yaml, and of `calibration` of patrol slam.
    {"places_lidar", "override_lidar_pose"},
    {"*.places_lidar", "*.override_lidar_pose"},
    {"turn_scale", "rotation_scale"},
    {"*.turn_scale", "*.rotation_scale"},
    {"steering_rad_per_m", "steering_bias_rad_per_m"},
    {"*.steering_rad_per_m", "*.steering_bias_rad_per_m"},

    // Stack: navigation and docking; patrol plan.
    {"stack.plan", "stack.navigation"},

    // Stack: missions and inspection.

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

std::string renamed_setting(std::string_view path) {
  std::string renamed;
  while (!path.empty()) {
    const std::size_t end = std::min(path.find('.'), path.size());
    renamed = rename_last((renamed.empty() ? "" : renamed + ".") + std::string(path.substr(0, end)));
    path.remove_prefix(std::min(end + 1, path.size()));
  }
  return renamed;
}

}  // namespace patrol::io
