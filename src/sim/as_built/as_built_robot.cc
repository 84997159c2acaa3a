#include "sim/as_built/as_built_robot.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/geometry/angles.h"
#include "core/gravity.h"
#include "core/random.h"

namespace patrol::sim {
namespace {

/// Names of the values of a sensor's mount in the ground truth, after its frame, [axis].
constexpr const char* kMountPosition[] = {".x_m", ".y_m", ".z_m"};
constexpr const char* kMountAngle[] = {".roll_rad", ".pitch_rad", ".yaw_rad"};

/// Returns the specific force in the frame of the IMU while the body stands level.
Eigen::Vector3d force_at_rest_mps2(const RobotDescription& robot) {
  const auto imu = robot.T_body_sensor.find("imu");
  const Eigen::Vector3d up_mps2 = kGravity_mps2 * Eigen::Vector3d::UnitZ();
  return imu == robot.T_body_sensor.end() ? up_mps2 : imu->second.rotation.conjugate() * up_mps2;
}

}  // namespace

AsBuiltRobot::AsBuiltRobot(const AsBuiltSettings& settings, RobotDescription nominal, std::uint64_t seed)
    : settings_(settings), seed_(seed), nominal_(std::move(nominal)), actual_(nominal_) {
  validate(settings, "as_built");
  if (!settings_.enabled) return;
  mount_sensors();
  const PlacementTolerances& placement = settings_.placement;
  T_surveyed_start_ = {uniform("placement/position", placement.position_m, 0),
                       uniform("placement/position", placement.position_m, 1),
                       uniform("placement/yaw", to_rad(placement.yaw_deg))};
}

RandomStream AsBuiltRobot::stream(const std::string& term) const { return {seed_, "as_built/" + term}; }

double AsBuiltRobot::uniform(const std::string& term, double tolerance, std::uint64_t index) const {
  if (!settings_.enabled) return 0.0;
  return tolerance * (2.0 * stream(term).uniform(0, index) - 1.0);
}

double AsBuiltRobot::normal(const std::string& term, double std, std::uint64_t index) const {
  if (!settings_.enabled) return 0.0;
  return std * stream(term).normal(0, index);
}

/// The coil's mount is left out: its servos have alignment errors of their own (sensors.antenna).
void AsBuiltRobot::mount_sensors() {
  const MountingTolerances& mounting = settings_.mounting;
  const double angle_rad = to_rad(mounting.angle_deg);
  for (auto& [frame, T_body_sensor] : actual_.T_body_sensor) {
    if (frame == "tem_mount") continue;
    const std::string position = "mounting/" + frame + "/position", angle = "mounting/" + frame + "/angle";
    const Pose3 T_nominal_actual{
        {uniform(position, mounting.position_m, 0), uniform(position, mounting.position_m, 1),
         uniform(position, mounting.position_m, 2)},
        quaternion_from_rpy(uniform(angle, angle_rad, 0), uniform(angle, angle_rad, 1), uniform(angle, angle_rad, 2))};
    T_body_sensor = T_body_sensor * T_nominal_actual;
  }
}

DeviceClock AsBuiltRobot::clock(const std::string& device) const {
  if (!settings_.enabled) return {};
  const ClockTolerances& clock = settings_.clock;
  return {uniform("clock/" + device + "/offset", clock.offset_s),
          1e-6 * uniform("clock/" + device + "/drift", clock.drift_ppm), clock.transport_jitter_s, seed_, device};
}

LidarErrors AsBuiltRobot::lidar(const std::string& frame) const {
  if (!settings_.enabled) return {};
  const LidarTolerances& lidar = settings_.lidar;
  const LidarTolerances measured = frame == "lidar" ? lidar : LidarTolerances{};  // the calibration is of one device
  const std::string term = "lidar/" + frame + "/";
  const double tilt_rad = to_rad(lidar.axis_tilt_deg), cone_rad = to_rad(lidar.cone_deg);
  return {.noise_ratio = lidar.noise_ratio,
          .range_offset_m = measured.measured_range_offset_m + uniform(term + "range_offset", lidar.range_offset_m),
          .range_scale = measured.measured_range_scale + uniform(term + "range_scale", lidar.range_scale),
          .reflectivity_m = measured.measured_reflectivity_m + uniform(term + "reflectivity", lidar.reflectivity_m),
          .incidence_m = measured.measured_incidence_m + uniform(term + "incidence", lidar.incidence_m),
          .axis_tilt_x_rad = uniform(term + "axis_tilt", tilt_rad, 0),
          .axis_tilt_y_rad = uniform(term + "axis_tilt", tilt_rad, 1),
          .cone_rad = 0.5 * (cone_rad + uniform(term + "cone", cone_rad)),
          .rate_std = lidar.rate_std};
}

TriadErrors AsBuiltRobot::triad(const std::string& term, double bias_std, double bias_std_per_k) const {
  TriadErrors errors;
  const double misalignment_rad = to_rad(settings_.imu.misalignment_std_deg);
  for (int row = 0; row < 3; ++row) {
    const auto axis = static_cast<std::uint64_t>(row);
    errors.bias[row] = normal(term + "/bias", bias_std, axis);
    errors.bias_per_k[row] = normal(term + "/bias_per_k", bias_std_per_k, axis);
    for (int col = 0; col < 3; ++col) {
      const auto index = 3 * axis + static_cast<std::uint64_t>(col);
      errors.distortion(row, col) = row == col ? normal(term + "/scale", settings_.imu.scale_std, axis)
                                               : normal(term + "/misalignment", misalignment_rad, index);
    }
  }
  return errors;
}

ImuErrors AsBuiltRobot::imu() const {
  const ImuTolerances& imu = settings_.imu;
  if (!settings_.enabled) return {};
  ImuErrors errors{.gyro = triad("imu/gyro", imu.gyro_bias_std_radps, imu.gyro_bias_std_radps_per_k),
                   .accel = triad("imu/accel", imu.accel_bias_std_mps2, imu.accel_bias_std_mps2_per_k),
                   .warming_k = imu.warming_k,
                   .warming_time_s = imu.warming_time_s};
  for (int i = 0; i < 9; ++i) {
    errors.g_sensitivity(i / 3, i % 3) =
        normal("imu/g_sensitivity", imu.g_sensitivity_std_radps_per_mps2, static_cast<std::uint64_t>(i));
  }
  return errors;
}

JointErrors AsBuiltRobot::joints() const {
  if (!settings_.enabled || (!nominal_.wheels.empty() && !nominal_.tracks)) return {};
  const double zero_offset_rad = to_rad(settings_.joint_encoders.zero_offset_deg),
               play_rad = to_rad(settings_.joint_encoders.play_deg);
  JointErrors errors;
  for (std::size_t joint = 0; joint < nominal_.joint_names.size(); ++joint) {
    errors.zero_offset_rad.push_back(uniform("joints/zero_offset", zero_offset_rad, joint));
    errors.play_rad.push_back(0.75 * play_rad + uniform("joints/play", 0.25 * play_rad, joint));
  }
  return errors;
}

TrackErrors AsBuiltRobot::tracks() const {
  if (!settings_.enabled) return {};
  const TrackTolerances& tracks = settings_.tracks;
  return {.sprocket_scale = {1.0 + uniform("tracks/sprocket", tracks.sprocket_scale, 0),
                             1.0 + uniform("tracks/sprocket", tracks.sprocket_scale, 1)},
          .friction_scale = 1.0 + uniform("tracks/friction", tracks.friction_scale),
          .missed_edge_probability =
              0.5 * (tracks.missed_edge_probability + uniform("tracks/missed_edge", tracks.missed_edge_probability)),
          .gauge_error_m = uniform("tracks/gauge", tracks.gauge_m)};
}

WheelErrors AsBuiltRobot::wheels() const {
  if (!settings_.enabled) return {};
  const WheelTolerances& wheels = settings_.wheels;
  WheelErrors errors{.radius_scale = {},
                     .friction_scale = 1.0 + uniform("wheels/friction", wheels.friction_scale),
                     .gauge_error_m = uniform("wheels/gauge", wheels.gauge_m)};
  for (std::size_t wheel = 0; wheel < nominal_.wheels.size(); ++wheel)
    errors.radius_scale.push_back(1.0 + uniform("wheels/radius", wheels.radius_scale, wheel));
  return errors;
}

double AsBuiltRobot::foot_friction_scale() const {
  return 1.0 + uniform("legs/friction", settings_.legs.friction_scale);
}

double AsBuiltRobot::uwb_delay_m(int anchor) const {
  return uniform("uwb/anchor_delay", settings_.uwb.anchor_delay_m, static_cast<std::uint64_t>(anchor)) +
         uniform("uwb/tag_delay", settings_.uwb.tag_delay_m);
}

DepthCameraErrors AsBuiltRobot::depth_camera() const {
  const DepthCameraTolerances& camera = settings_.depth_camera;
  return {.focal_scale = 1.0 + uniform("depth_camera/focal", camera.focal_scale),
          .cx_px = uniform("depth_camera/principal_point", camera.principal_point_px, 0),
          .cy_px = uniform("depth_camera/principal_point", camera.principal_point_px, 1),
          .inverse_depth_per_m = uniform("depth_camera/inverse_depth", camera.inverse_depth_per_m)};
}

AsBuiltTruth AsBuiltRobot::truth(const std::vector<int>& uwb_anchors, const ImuErrors& sensor) const {
  AsBuiltTruth truth;
  if (!settings_.enabled) return truth;
  const auto add = [&](std::string name, double value) { truth.values.emplace_back(std::move(name), value); };
  const ImuErrors imu_errors = imu();
  const LidarErrors lidar_errors = lidar("lidar");
  add("lidar.time_offset_s", clock("lidar").offset_s() - clock("firmware").offset_s());
  add("lidar.clock_drift_s_per_s", clock("lidar").drift() - clock("firmware").drift());
  add("lidar.range_offset_m", lidar_errors.range_offset_m);
  for (const auto& [frame, T_body_sensor] : actual_.T_body_sensor) {
    const Pose3 T_nominal_actual = nominal_.T_body(frame).inverse() * T_body_sensor;
    const Eigen::Vector3d rotation = 2.0 * T_nominal_actual.rotation.vec();  // small angles about x, y, z
    for (int axis = 0; axis < 3; ++axis) add(frame + kMountPosition[axis], T_nominal_actual.position[axis]);
    for (int axis = 0; axis < 3; ++axis) add(frame + kMountAngle[axis], rotation[axis]);
  }
  const Eigen::Vector3d by_gravity_radps = imu_errors.g_sensitivity * force_at_rest_mps2(nominal_);
  constexpr const char* kAxes[] = {"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis) {
    add(fmt::format("imu.gyro_{}_bias_radps", kAxes[axis]), imu_errors.gyro.bias[axis] + sensor.gyro.bias[axis]);
    add(fmt::format("imu.accel_{}_bias_mps2", kAxes[axis]), imu_errors.accel.bias[axis] + sensor.accel.bias[axis]);
    add(fmt::format("imu.gyro_{}_warming_radps", kAxes[axis]), imu_errors.warming_k * imu_errors.gyro.bias_per_k[axis]);
    add(fmt::format("imu.accel_{}_warming_mps2", kAxes[axis]),
        imu_errors.warming_k * imu_errors.accel.bias_per_k[axis]);
    add(fmt::format("imu.gyro_{}_by_gravity_radps", kAxes[axis]), by_gravity_radps[axis]);
  }
  add("imu.gyro_z_scale_error", imu_errors.gyro.distortion(2, 2));
  if (nominal_.tracks) {
    add("tracks.left_sprocket_scale", tracks().sprocket_scale[0]);
    add("tracks.right_sprocket_scale", tracks().sprocket_scale[1]);
    add("tracks.gauge_error_m", tracks().gauge_error_m);
  }
  const WheelErrors wheel_errors = wheels();
  for (std::size_t wheel = 0; wheel < nominal_.wheels.size(); ++wheel)
    add(fmt::format("wheels.{}.radius_scale", nominal_.wheels[wheel].link), wheel_errors.radius_scale[wheel]);
  if (!nominal_.wheels.empty()) add("wheels.gauge_error_m", wheel_errors.gauge_error_m);
  for (const int anchor : uwb_anchors) add(fmt::format("uwb.anchor_{}.delay_m", anchor), uwb_delay_m(anchor));
  add("placement.x_m", T_surveyed_start_.x);
  add("placement.y_m", T_surveyed_start_.y);
  add("placement.yaw_rad", T_surveyed_start_.yaw);
  return truth;
}

Pose3 mount_error(const AsBuiltTruth& truth, const std::string& frame) {
  const auto value = [&](const std::string& name) {
    const auto found = std::ranges::find(truth.values, name, [](const auto& entry) { return entry.first; });
    return found == truth.values.end() ? 0.0 : found->second;
  };
  Eigen::Vector3d position_m, vector;  // vector part of the quaternion: half of the angles
  for (int axis = 0; axis < 3; ++axis) {
    position_m[axis] = value(frame + kMountPosition[axis]);
    vector[axis] = 0.5 * value(frame + kMountAngle[axis]);
  }
  const double w = std::sqrt(std::max(0.0, 1.0 - vector.squaredNorm()));
  return {position_m, Eigen::Quaterniond(w, vector.x(), vector.y(), vector.z()).normalized()};
}

}  // namespace patrol::sim
