#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "sim/as_built/as_built_robot.h"

namespace patrol::sim {

/// Collects every value of a robot under the number of section `as_built` that it is drawn with, "group.field: ...".
class DrawnValues {
 public:
  explicit DrawnValues(const AsBuiltRobot& robot) {
    for (const auto& [frame, T_body_sensor] : robot.actual().T_body_sensor) {
      add("mounting.position_m", frame, T_body_sensor.position);
      add("mounting.angle_deg", frame, T_body_sensor.rotation.coeffs());
    }
    for (const std::string device : {"firmware", "lidar", "uwb"}) {
      const DeviceClock clock = robot.clock(device);
      add("clock.offset_s", device, clock.offset_s());
      add("clock.drift_ppm", device, clock.drift());
      for (const std::uint64_t message : {0, 1, 9}) {
        add("clock.transport_jitter_s", fmt::format("{} {}", device, message),
            to_seconds(clock.transport_delay(message)));
      }
    }
    for (const std::string frame : {"lidar", "lidar3d"}) add_lidar(frame, robot.lidar(frame));
    const JointErrors joints = robot.joints();
    for (std::size_t joint = 0; joint < robot.nominal().joint_names.size(); ++joint) {
      const bool is_drawn = !joints.zero_offset_rad.empty();
      add("joint_encoders.zero_offset_deg", std::to_string(joint), is_drawn ? joints.zero_offset_rad[joint] : 0.0);
      add("joint_encoders.play_deg", std::to_string(joint), is_drawn ? joints.play_rad[joint] : 0.0);
    }
    const TrackErrors tracks = robot.tracks();
    add("tracks.sprocket_scale", "left", tracks.sprocket_scale[0]);
    add("tracks.sprocket_scale", "right", tracks.sprocket_scale[1]);
    add("tracks.friction_scale", "", tracks.friction_scale);
    add("tracks.missed_edge_probability", "", tracks.missed_edge_probability);
    add("tracks.gauge_m", "", tracks.gauge_error_m);
    const WheelErrors wheels = robot.wheels();
    for (std::size_t wheel = 0; wheel < robot.nominal().wheels.size(); ++wheel)
      add("wheels.radius_scale", std::to_string(wheel), wheels.radius_scale.empty() ? 1.0 : wheels.radius_scale[wheel]);
    add("wheels.friction_scale", "", wheels.friction_scale);
    add("wheels.gauge_m", "", wheels.gauge_error_m);
    add("legs.friction_scale", "", robot.foot_friction_scale());
    add_imu(robot.imu());
    for (const int anchor : {0, 1, 5}) {
      add(kUwbDelays, std::to_string(anchor), robot.uwb_delay_m(anchor));
      add("uwb.received_power_std_db", std::to_string(anchor), robot.uwb_power().offset_db(anchor, {0.6, -0.8, 0.1}));
    }
    const DepthCameraErrors camera = robot.depth_camera();
    add("depth_camera.focal_scale", "", camera.focal_scale);
    add("depth_camera.principal_point_px", "x", camera.cx_px);
    add("depth_camera.principal_point_px", "y", camera.cy_px);
    add("depth_camera.inverse_depth_per_m", "", camera.inverse_depth_per_m);
    add_scanner(robot.scanner());
    const Pose2 start = robot.start({});
    add("placement.position_m", "x", start.x);
    add("placement.position_m", "y", start.y);
    add("placement.yaw_deg", "", start.yaw);
  }

  /// Owner of the delay of an anchor, which is the sum of two draws.
  static constexpr const char* kUwbDelays = "uwb.anchor_delay_m and uwb.tag_delay_m";

  /// {name: value}
  const std::map<std::string, double>& values() const { return values_; }

 private:
  void add(const std::string& owner, const std::string& part, double value) {
    EXPECT_TRUE(values_.emplace(owner + ": " + part, value).second) << owner << ": " << part;
  }
  template <typename Derived>
  void add(const std::string& owner, const std::string& part, const Eigen::DenseBase<Derived>& matrix) {
    for (int row = 0; row < matrix.rows(); ++row) {
      for (int col = 0; col < matrix.cols(); ++col)
        add(owner, fmt::format("{} {} {}", part, row, col), matrix(row, col));
    }
  }
  void add_lidar(const std::string& frame, const LidarErrors& lidar) {
    add("lidar.noise_ratio", frame, lidar.noise_ratio);
    add("lidar.range_offset_m", frame, lidar.range_offset_m);
    add("lidar.range_scale", frame, lidar.range_scale);
    add("lidar.reflectivity_m", frame, lidar.reflectivity_m);
    add("lidar.incidence_m", frame, lidar.incidence_m);
    add("lidar.axis_tilt_deg", frame + " x", lidar.axis_tilt_x_rad);
    add("lidar.axis_tilt_deg", frame + " y", lidar.axis_tilt_y_rad);
    add("lidar.cone_deg", frame, lidar.cone_rad);
    add("lidar.rate_std", frame, lidar.rate_std);
  }
  void add_triad(const std::string& bias, const std::string& name, const TriadErrors& triad) {
    add(bias, name, triad.bias);
    add(bias + "_per_k", name, triad.bias_per_k);
    for (int row = 0; row < 3; ++row) {
      for (int col = 0; col < 3; ++col) {
        add(row == col ? "imu.scale_std" : "imu.misalignment_std_deg", fmt::format("{} {} {}", name, row, col),
            triad.distortion(row, col));
      }
    }
  }
  void add_imu(const ImuErrors& imu) {
    add_triad("imu.gyro_bias_std_radps", "gyro", imu.gyro);
    add_triad("imu.accel_bias_std_mps2", "accel", imu.accel);
    add("imu.g_sensitivity_std_radps_per_mps2", "", imu.g_sensitivity);
    add("imu.warming_k", "", imu.warming_k);
    add("imu.warming_time_s", "", imu.warming_time_s);
  }
  void add_scanner(const ScannerErrors& scanner) {
    add("scanner.angle_noise_ratio", "", scanner.angle_noise_ratio);
    add("scanner.range_offset_ratio", "", scanner.range_offset_ratio);
    add("scanner.collimation_std_arcsec", "", scanner.collimation_rad);
    add("scanner.trunnion_std_arcsec", "", scanner.trunnion_rad);
    add("scanner.vertical_index_std_arcsec", "", scanner.vertical_index_rad);
    for (const auto& [name, encoder] : {std::pair("horizontal", scanner.horizontal_encoder_rad),
                                        std::pair("vertical", scanner.vertical_encoder_rad)}) {
      add("scanner.eccentricity_std_arcsec", name, encoder.head<2>());
      add("scanner.encoder_harmonic_std_arcsec", name, encoder.tail<2>());
    }
    add("scanner.beam_offset_std_m", "left", scanner.beam_left_m);
    add("scanner.beam_offset_std_m", "up", scanner.beam_up_m);
    add("scanner.range_scale_std", "", scanner.range_scale);
    add("scanner.cyclic_range_std_m", "sine", scanner.cyclic_sine_m);
    add("scanner.cyclic_range_std_m", "cosine", scanner.cyclic_cosine_m);
    add("scanner.cyclic_wavelength_m", "", scanner.cyclic_wavelength_m);
  }

  std::map<std::string, double> values_;
};

}  // namespace patrol::sim
