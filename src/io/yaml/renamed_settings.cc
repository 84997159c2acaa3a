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
    {"*.range_noise_m", "*.range_noise_std_m"},
    {"*.range_resolution_m", "*.range_quantization_m"},
    {"*.angle_noise_deg", "*.angle_noise_std_deg"},
    {"*.grazing_deg", "*.max_incidence_deg"},
    {"*.dropout", "*.dropout_probability"},
    {"*.dark_range_m", "*.max_range_10pct_m"},
    {"*.rain_rate", "*.false_return_rate_per_m"},
    {"*.relative_noise", "*.relative_noise_std"},
    {"sensors.dust.echo_share", "sensors.dust.backscatter_probability"},
    {"sensors.imu.gyro_noise_radps_rthz", "sensors.imu.gyro_noise_density_radps_per_sqrt_hz"},
    {"sensors.imu.gyro_bias_radps", "sensors.imu.gyro_bias_std_radps"},
    {"sensors.imu.gyro_bias_walk_radps2_rthz", "sensors.imu.gyro_bias_random_walk_radps_per_sqrt_s"},
    {"sensors.imu.accel_noise_mps2_rthz", "sensors.imu.accel_noise_density_mps2_per_sqrt_hz"},
    {"sensors.imu.accel_bias_mps2", "sensors.imu.accel_bias_std_mps2"},
    {"sensors.imu.accel_bias_walk_mps3_rthz", "sensors.imu.accel_bias_random_walk_mps2_per_sqrt_s"},
    {"sensors.imu.scale_error", "sensors.imu.scale_error_std"},
    {"sensors.imu.misalignment_deg", "sensors.imu.misalignment_std_deg"},
    {"sensors.foot_contact.noise_n", "sensors.foot_contact.noise_std_n"},
    {"sensors.foot_contact.offset_n", "sensors.foot_contact.offset_std_n"},
    {"sensors.joint_encoders.counts_per_turn", "sensors.joint_encoders.counts_per_revolution"},
    {"sensors.joint_encoders.speed_filter_s", "sensors.joint_encoders.velocity_filter_time_constant_s"},
    {"sensors.hall.ticks_per_motor_turn", "sensors.hall.counts_per_motor_revolution"},
    {"sensors.hall.missed_tick_probability", "sensors.hall.missed_edge_probability"},
    {"sensors.gnss.fix_noise_m", "sensors.gnss.fix_noise_std_m"},
    {"sensors.gnss.float_noise_m", "sensors.gnss.float_noise_std_m"},
    {"sensors.gnss.error_time_s", "sensors.gnss.error_correlation_time_s"},
    {"sensors.gnss.fix_sky", "sensors.gnss.min_open_sky_fix"},
    {"sensors.gnss.float_sky", "sensors.gnss.min_open_sky_float"},
    {"sensors.gnss.fix_delay_s", "sensors.gnss.fix_reacquisition_time_s"},
    {"sensors.depth_camera.depth_noise_per_m", "sensors.depth_camera.depth_noise_std_per_m"},
    {"sensors.depth_camera.edge_loss", "sensors.depth_camera.edge_dropout_probability"},
    {"sensors.depth_camera.edge_step", "sensors.depth_camera.edge_threshold"},
    {"sensors.scanner.grey_noise_m", "sensors.scanner.gray_noise_std_m"},
    {"sensors.scanner.tilt_error_deg", "sensors.scanner.tilt_error_std_deg"},
    {"sensors.scanner.black_range_m", "sensors.scanner.max_range_2pct_m"},
    {"sensors.scanner.beam_exit_m", "sensors.scanner.beam_exit_diameter_m"},
    {"sensors.scanner.beam_spread_rad", "sensors.scanner.beam_divergence_rad"},
    {"sensors.tdlas.noise_ppm_m", "sensors.tdlas.noise_std_ppm_m"},
    {"sensors.tem.noise_tps", "sensors.tem.noise_std_tps"},
    {"sensors.tem.current_std", "sensors.tem.relative_moment_std"},
    {"sensors.tem.steel_rate", "sensors.tem.steel_response"},
    {"sensors.tem.steel_spread", "sensors.tem.steel_log_std"},
    {"sensors.tem.steel_anisotropy", "sensors.tem.steel_anisotropy_std"},
    {"sensors.tem.gate_width", "sensors.tem.relative_gate_width"},
    {"sensors.ultrasonic.fire_together", "sensors.ultrasonic.group_size"},
    {"sensors.ultrasonic.smooth_deg", "sensors.ultrasonic.specular_cutoff_deg"},
    {"sensors.ultrasonic.rough_echo", "sensors.ultrasonic.rough_echo_ratio"},
    {"sensors.ultrasonic.least_echo", "sensors.ultrasonic.detection_threshold"},
    {"sensors.ultrasonic.crosstalk", "sensors.ultrasonic.crosstalk_probability"},
    {"sensors.uwb.loss", "sensors.uwb.loss_probability"},
    {"sensors.uwb.blocked_loss", "sensors.uwb.nlos_loss_probability"},
    {"sensors.uwb.blocked_excess_m", "sensors.uwb.nlos_bias_m"},
    {"sensors.barometer.noise_pa", "sensors.barometer.noise_std_pa"},
    {"sensors.barometer.offset_pa", "sensors.barometer.offset_std_pa"},
    {"sensors.barometer.drift_pa", "sensors.barometer.drift_std_pa"},
    {"sensors.barometer.drift_time_s", "sensors.barometer.drift_correlation_time_s"},
    {"sensors.barometer.temperature_coefficient_pa_per_k", "sensors.barometer.temperature_coefficient_std_pa_per_k"},
    {"sensors.magnetometer.noise_t", "sensors.magnetometer.noise_std_t"},
    {"sensors.magnetometer.hard_iron_t", "sensors.magnetometer.hard_iron_std_t"},
    {"sensors.magnetometer.soft_iron", "sensors.magnetometer.soft_iron_std"},
    {"track_drive.gauge_factor", "track_drive.effective_gauge_factor"},
    {"track_drive.proportional_nms", "track_drive.kp_nms"},
    {"track_drive.integral_nm", "track_drive.ki_nm"},
    {"track_drive.derivative_nms2", "track_drive.kd_nms2"},
    {"track_drive.observer_radps", "track_drive.observer_bandwidth_radps"},
    {"low_obstacles.beside_m", "low_obstacles.max_lateral_offset_m"},
    {"low_obstacles.apart_m", "low_obstacles.min_spacing_m"},
    {"low_obstacles.clear_ends_m", "low_obstacles.end_clearance_m"},

    // Scenario.
    {"remote", "teleop"},
    {"teleop.drive", "teleop.route"},
    {"teleop.driver", "teleop.operator"},
    {"teleop.operator.reaction_s", "teleop.operator.reaction_time_s"},
    {"teleop.operator.steering_noise_radps", "teleop.operator.steering_noise_std_radps"},
    {"teleop.operator.stop_for_people_m", "teleop.operator.pedestrian_stop_distance_m"},
    {"teleop.operator.meets_robot", "teleop.operator.wait_for_robot"},
    {"props", "static_obstacles"},
    {"*.turn_deg", "*.yaw_deg"},
    {"lining", "lining_deformation"},
    {"water", "water_bodies"},
    {"light.brightness_share", "light.intensity"},
    {"kept_clearance_m", "min_clearance_m"},
    {"any_angle_most_cells", "max_any_angle_cells"},
    {"unknown", "allow_unknown"},
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
