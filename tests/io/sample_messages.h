#pragma once

#include <limits>
#include <tuple>

#include "core/ground_truth.h"
#include "core/messages.h"
#include "core/sensors/registry.h"
#include "io/ros/ros_messages.h"

namespace patrol::test {

using namespace std::chrono_literals;

inline const Time kSampleStamp = 12s + 345'678'901ns;

/// One of each message, every field away from its default. Values are fit for float32 where ROS has float32.
inline LaserScan sample_scan() {
  const float infinity = std::numeric_limits<float>::infinity();
  return {.stamp = kSampleStamp,
          .angle_min_rad = -2.5,
          .angle_increment_rad = 0.25,
          .time_increment_s = 0.0625,
          .scan_time_s = 0.125,
          .range_min_m = 0.5,
          .range_max_m = 30.0,
          .ranges_m = {3.25F, -infinity, infinity, 1.5F},
          .intensities = {1.0F, 0.0F, 255.0F, 2.0F}};
}
inline PointCloud sample_cloud() {
  return {.stamp = kSampleStamp,
          .points = {{1.0F, 2.0F, 3.0F, 4.0F, 0.5F, 15}, {-1.5F, 0.25F, 9.0F, 255.0F, 0.75F, 65535}}};
}
inline Imu sample_imu() {
  return {
      .stamp = kSampleStamp, .angular_velocity_radps = {0.1, -0.2, 0.3}, .linear_acceleration_mps2 = {1.0, -2.0, 9.81}};
}
inline JointState sample_joints() {
  return {.stamp = kSampleStamp, .position_rad = {0.1, 0.8}, .velocity_radps = {1.0, -2.0}, .effort_nm = {3.5, 4.5}};
}
inline FootContacts sample_contacts() { return {.stamp = kSampleStamp, .force_n = {10.0, 0.0, 20.5, 30.25}}; }
inline GasReading sample_gas() {
  return {.stamp = kSampleStamp,
          .column_ppm_m = 123.5,
          .path_length_m = std::numeric_limits<double>::infinity(),
          .mean_mg_m3 = 7.25};
}
inline GnssFix sample_fix(GnssStatus status = GnssStatus::kFix) {
  return {.stamp = kSampleStamp,
          .status = status,
          .latitude_deg = 52.5,
          .longitude_deg = -13.25,
          .altitude_m = 34.5,
          .position_std_m = {0.5, 0.25, 2.0}};
}
inline TrackTicks sample_ticks() { return {.stamp = kSampleStamp, .left = -123456789012, .right = 42}; }
inline UwbRange sample_uwb() { return {.stamp = kSampleStamp, .anchor = 7, .range_m = 12.345}; }
inline UltrasonicRange sample_ultrasonic() {
  return {.stamp = kSampleStamp,
          .transducer = 11,
          .field_of_view_rad = 0.5,
          .range_min_m = 0.25,
          .range_max_m = 4.0,
          .range_m = 1.75F};
}
inline DepthImage sample_depth() {
  return {.stamp = kSampleStamp,
          .width = 3,
          .height = 2,
          .fx_px = 60.5,
          .fy_px = 61.5,
          .cx_px = 1.5,
          .cy_px = 1.0,
          .depth_mm = {1000, 2000, 0, 65535, 1, 256}};
}
inline TeleopCommand sample_teleop() {
  return {.stamp = kSampleStamp, .vx_mps = 0.5, .yaw_rate_radps = -0.25, .save_goal = true, .hand_over = true};
}
inline PanoramicScan sample_panorama() {
  return {.stamp = kSampleStamp, .points = {{1.0F, -2.0F, 0.5F, 120.0F}, {-4.0F, 0.25F, 5.5F, 7.0F}}};
}
inline AntennaState sample_antenna() { return {.stamp = kSampleStamp, .yaw_rad = 0.5, .pitch_rad = -0.25}; }
inline TemSounding sample_sounding() {
  return {.stamp = kSampleStamp,
          .moment_am2 = 240.0,
          .gate_s = {4e-6, 8e-6},
          .rate_tps = {2e-5, -1e-6},
          .std_tps = {1e-8, 2e-8}};
}
inline LiningResult sample_lining() {
  return {.stamp = kSampleStamp,
          .station = "goal_2",
          .T_map_body = {1.0, 2.0, 0.5},
          .is_registered = true,
          .registration_rms_m = 0.002,
          .registration_inlier_ratio = 0.75,
          .correction_m = 0.04,
          .cells = {{.ring = 12, .clock_deg = 95.0, .inward_m = 0.003, .std_m = 0.0002, .points = 340}},
          .lines = {{.ring = 12, .name = "9-3", .change_m = -0.006, .std_m = 0.0003}},
          .findings = {{.ring = 12,
                        .clock_deg = 95.0,
                        .inward_m = 0.003,
                        .std_m = 0.0002,
                        .level = WarningLevel::kWarning,
                        .p_map = {3.0, -4.0, 1.5}}}};
}
inline WaterResult sample_water() {
  WaterResult water{.stamp = kSampleStamp,
                    .station = "goal_4",
                    .T_map_body = {1.0, 2.0, 0.5},
                    .soundings = 35,
                    .antenna_error_deg = 0.4,
                    .rock_spm = 0.002,
                    .evidence = 120.0,
                    .is_found = true,
                    .level = WarningLevel::kAlarm,
                    .p_map = {-170.0, 3.0, 2.0},
                    .distance_m = 18.0,
                    .distance_low_m = 16.5,
                    .distance_high_m = 19.5,
                    .azimuth_deg = 10.0,
                    .elevation_deg = -5.0,
                    .radius_m = 5.0,
                    .radius_low_m = 4.5,
                    .radius_high_m = 5.5};
  water.covariance_m2 << 1.0, 0.25, 0.5, 0.25, 2.0, -0.125, 0.5, -0.125, 3.0;
  return water;
}
inline LocalizationConfidence sample_trust() {
  return {.stamp = kSampleStamp, .confidence = 0.25, .max_std_m = 0.75, .max_std_direction_rad = 1.5, .is_lost = true};
}
inline CalibrationEstimate sample_calibration() {
  return {.stamp = kSampleStamp,
          .values = {{.name = "lidar.time_offset_s", .value = -0.02, .std = 0.001},
                     {.name = anchor_delay_name(3), .value = 0.25, .std = 0.05}}};
}
inline Eigen::Matrix3d sample_covariance() {
  Eigen::Matrix3d P;
  P << 1.0, 2.0, 3.0, 2.0, 4.0, 5.0, 3.0, 5.0, 6.0;
  return P;
}
inline Pose3 sample_pose() { return {{1.0, -2.0, 0.5}, Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5)}; }
inline OdometryEstimate sample_odometry() {
  return {.stamp = kSampleStamp,
          .T_odom_body = sample_pose(),
          .twist = {{0.5, 0.1, -0.1}, {0.01, 0.02, 0.03}},
          .planar_covariance = sample_covariance()};
}
inline PoseEstimate sample_estimate() {
  return {.stamp = kSampleStamp, .T_map_body = {1.0, 2.0, -3.0}, .covariance = sample_covariance()};
}
inline ParticleSet sample_particles() {
  return {.stamp = kSampleStamp, .T_map_body = {{1.0, 2.0, 0.5}, {3.0, 4.0, -0.5}}, .weights = {0.25, 0.75}};
}
inline MapUpdate sample_map() {
  MapUpdate update{
      .stamp = kSampleStamp,
      .map = OccupancyGrid({.resolution_m = 0.05, .width = 3, .height = 2, .origin_m = {-1.0, 2.5}}, kUnknown)};
  update.map.at({2, 0}) = kOccupied;
  update.map.at({0, 1}) = kFree;
  return update;
}
inline SiteRegistration sample_registration() {
  return {.stamp = kSampleStamp, .T_site_map = {11.0, 8.0, 0.5}, .covariance = sample_estimate().covariance};
}
inline Path sample_path() { return {.stamp = kSampleStamp, .T_map_body = {{1.0, 2.0, 0.5}, {3.0, 4.0, -0.5}}}; }
inline VelocityCommand sample_command() {
  return {.stamp = kSampleStamp, .vx_mps = 0.5, .vy_mps = -0.25, .yaw_rate_radps = 1.0};
}
inline Event sample_event() {
  return {.stamp = kSampleStamp,
          .kind = EventKind::kGasAlarm,
          .subject = "regulator_box_2",
          .text = "methane at the box",
          .value = 512.0,
          .T_map_body = {1.0, 2.0, 0.5},
          .p_map_target = {3.0, -4.0}};
}
inline GroundTruth sample_truth() {
  return {.stamp = kSampleStamp, .T_world_body = sample_pose(), .twist = {{0.5, 0.1, -0.1}, {0.01, 0.02, 0.03}}};
}
inline SimState sample_state() { return {.stamp = kSampleStamp, .qpos = {1.0, 2.0, 3.0}, .mocap = {4.0, 5.0}}; }
inline Collision sample_collision() { return {.stamp = kSampleStamp, .first = "FL_shank", .second = "house_7"}; }
inline AsBuiltTruth sample_as_built() {
  return {.stamp = kSampleStamp, .values = {{"lidar.yaw_rad", 0.004}, {"imu.gyro_z_scale", 1.002}}};
}
inline io::TransformSet sample_transforms() {
  return {{{.stamp = kSampleStamp, .parent = "map", .child = "odom", .T_parent_child = sample_pose()},
           {.stamp = 1s, .parent = "odom", .child = "base_link", .T_parent_child = {}}}};
}

inline auto all_samples() {
  return std::tuple(
      sample_scan(), sample_cloud(), sample_imu(), sample_joints(), sample_contacts(), sample_gas(), sample_fix(),
      sample_ticks(), sample_uwb(), sample_ultrasonic(), sample_depth(), sample_teleop(), sample_panorama(),
      sample_antenna(), sample_sounding(), ScanCommand{kSampleStamp}, AntennaCommand{kSampleStamp, 0.5, -0.25},
      SoundingCommand{kSampleStamp}, WarningCommand{kSampleStamp, true, false}, sample_lining(), sample_water(),
      sample_trust(), sample_calibration(), sample_odometry(), sample_estimate(), UwbPoseEstimate{sample_estimate()},
      sample_particles(), sample_registration(), sample_map(), sample_path(), sample_command(), sample_event(),
      sample_truth(), sample_state(), sample_as_built(), sample_collision(), sample_transforms());
}

}  // namespace patrol::test
