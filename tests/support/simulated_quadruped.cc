#include "tests/support/simulated_quadruped.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "io/urdf.h"
#include "sim/leg_scale.h"
#include "tests/support/moments.h"
#include "tests/support/temporary_file.h"

namespace patrol::sim {
namespace {

AssembledModel assemble_quadruped(const std::string& world, const Pose2& T_world_start) {
  const test::TemporaryFile file("world.xml", world);
  return assemble_model(file.path(), kRobotUrdf, io::load_robot_description(kRobotUrdf), T_world_start);
}

}  // namespace

std::string make_world(const std::string& geoms) {
  return R"(<mujoco><option timestep="0.002" cone="elliptic" impratio="10"/>
    <default><geom contype="1" conaffinity="2"/></default><worldbody>)" +
         geoms + "</worldbody></mujoco>";
}

std::string make_flat_world(const std::string& geoms) {
  return make_world(R"(<geom name="ground" type="plane" size="100 100 1"/>)" + geoms);
}

WalkingRobot::WalkingRobot(const std::string& world, const Pose2& T_world_start, std::uint64_t seed,
                           const LocomotionSettings& settings)
    : WalkingRobot(assemble_quadruped(world, T_world_start), seed, settings) {}

WalkingRobot::WalkingRobot(AssembledModel model, std::uint64_t seed, const LocomotionSettings& settings)
    : WalkingRobot(std::move(model), io::load_robot_description(kRobotUrdf), seed, settings) {}

WalkingRobot::WalkingRobot(AssembledModel model, RobotDescription robot, std::uint64_t seed,
                           const LocomotionSettings& settings)
    : robot_(std::move(robot)),
      model_(std::move(model)),
      data_(make_data(*model_.physics)),
      culler_(*model_.physics),
      imu_sensor_({}, *model_.physics, seed),
      encoders_({}, *model_.physics, robot_.joint_names),
      foot_sensor_({}, *model_.physics, robot_.legs, seed),
      controller_(robot_, settings, model_.physics->opt.timestep),
      body_(mj_name2id(model_.physics.get(), mjOBJ_BODY, frame_id::kBody)),
      loaded_n_(20.0 * leg_scale(robot_).force) {
  for (std::size_t leg = 0; leg < kNumLegs; ++leg) {
    foot_geom_[leg] = mj_name2id(model_.physics.get(), mjOBJ_GEOM, robot_.legs[leg].foot_link.c_str());
  }
  for (std::size_t joint = 0; joint < motor_.size(); ++joint)
    motor_[joint] = mj_name2id(model_.physics.get(), mjOBJ_ACTUATOR, robot_.joint_names[joint].c_str());
  std::copy(model_.start_qpos.begin(), model_.start_qpos.end(), data_->qpos);
  mj_forward(model_.physics.get(), data_.get());
}

void WalkingRobot::drive(const VelocityCommand& command) {
  const mjModel& model = *model_.physics;
  const Time now = from_seconds(data_->time);
  imu_ = imu_sensor_.read(model, *data_, now, tick_);
  imu_.angular_velocity_radps.z() += gyro_bias_radps_;
  imu_.linear_acceleration_mps2 += accelerometer_bias_mps2_;
  joints_ = encoders_.read(*data_, now);
  contacts_ = foot_sensor_.read(model, *data_, now, tick_);
  const JointTorques torques = controller_.step({.imu = imu_, .joints = joints_, .feet = contacts_}, command);
  for (std::size_t joint = 0; joint < motor_.size(); ++joint)
    data_->ctrl[motor_[joint]] = torques[static_cast<Eigen::Index>(joint)];
}

void WalkingRobot::advance() {
  culler_.update(*data_);
  mj_Euler(model_.physics.get(), data_.get());
  mj_forward(model_.physics.get(), data_.get());
  ++tick_;
}

WalkReport WalkingRobot::walk(double vx_mps, double vy_mps, double yaw_rate_radps, double duration_s) {
  const VelocityCommand command{.stamp = {}, .vx_mps = vx_mps, .vy_mps = vy_mps, .yaw_rate_radps = yaw_rate_radps};
  const Pose2 start = to_pose2(T_world_body());
  const auto ticks = static_cast<int>(std::lround(duration_s / model_.physics->opt.timestep));
  WalkReport report;
  report.min_height_m = T_world_body().position.z();
  test::Moments forward, sideways, turn, roll, pitch, slip, error_x, error_y;
  std::array<bool, kNumLegs> was_loaded{};
  double last_yaw = start.yaw;
  for (int tick = 0; tick < ticks; ++tick) {
    step(command);
    const Pose3 pose = T_world_body();
    const Eigen::Matrix3d R = pose.rotation.toRotationMatrix();
    const Eigen::Vector3d velocity = velocity_mps();
    forward.add(velocity.x());
    sideways.add(velocity.y());
    const double yaw = to_yaw(pose.rotation);
    report.moved.yaw += wrap_angle(yaw - last_yaw);
    last_yaw = yaw;
    roll.add(std::atan2(R(2, 1), R(2, 2)));
    pitch.add(-std::asin(R(2, 0)));
    report.max_tilt_rad = std::max(report.max_tilt_rad, std::acos(std::min(1.0, R(2, 2))));
    report.min_height_m = std::min(report.min_height_m, pose.position.z());
    report.max_torque_nm = std::max(report.max_torque_nm, Eigen::Map<JointTorques>(data_->ctrl).cwiseAbs().maxCoeff());
    error_x.add(controller_.trunk().velocity_mps.x() - velocity.x());
    error_y.add(controller_.trunk().velocity_mps.y() - velocity.y());
    for (int leg = 0; leg < kNumLegs; ++leg) {
      const auto index = static_cast<std::size_t>(leg);
      const bool loaded = is_loaded(leg);
      if (loaded) slip.add(loaded_slip_mps(leg));
      if (!loaded && was_loaded[index]) ++report.steps_taken;
      was_loaded[index] = loaded;
    }
  }
  const double yaw_moved = report.moved.yaw;
  report.moved = start.inverse() * to_pose2(T_world_body());
  report.moved.yaw = yaw_moved;
  report.mean_forward_mps = forward.mean();
  report.mean_sideways_mps = sideways.mean();
  report.mean_yaw_rate_radps = yaw_moved / duration_s;
  report.roll_rms_rad = roll.std();
  report.pitch_rms_rad = pitch.std();
  report.slip_mps = slip.mean();
  report.velocity_error_mps = std::hypot(error_x.rms(), error_y.rms());
  report.has_fallen = controller_.has_fallen();
  return report;
}

Pose3 WalkingRobot::T_world_body() const {
  const mjtNum* position = data_->xpos + 3 * body_;
  const mjtNum* rotation = data_->xquat + 4 * body_;
  return {Eigen::Vector3d(position), Eigen::Quaterniond(rotation[0], rotation[1], rotation[2], rotation[3])};
}

Eigen::Vector3d WalkingRobot::velocity_mps() const {
  const Eigen::Vector3d in_world(data_->qvel[0], data_->qvel[1], data_->qvel[2]);
  return quaternion_from_yaw(-to_yaw(T_world_body().rotation)) * in_world;
}

/// Speed along the ground of the foot's material point that touches it.
double WalkingRobot::loaded_slip_mps(int leg) const {
  const int geom = foot_geom_[static_cast<std::size_t>(leg)];
  for (int i = 0; i < data_->ncon; ++i) {
    const mjContact& contact = data_->contact[i];
    if (contact.geom[0] != geom && contact.geom[1] != geom) continue;
    mjtNum velocity[6];
    mj_objectVelocity(model_.physics.get(), data_.get(), mjOBJ_GEOM, geom, velocity, 0);
    const Eigen::Vector3d omega(velocity), center(velocity + 3), normal(contact.frame);
    const Eigen::Vector3d arm = Eigen::Vector3d(contact.pos) - Eigen::Vector3d(data_->geom_xpos + 3 * geom);
    const Eigen::Vector3d sole = center + omega.cross(arm);
    return (sole - normal.dot(sole) * normal).norm();
  }
  return 0.0;
}

}  // namespace patrol::sim
