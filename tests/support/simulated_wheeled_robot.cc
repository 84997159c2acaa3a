#include "tests/support/simulated_wheeled_robot.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/angles.h"
#include "io/urdf.h"
#include "tests/support/temporary_file.h"

namespace patrol::sim {
namespace {

RobotDescription describe(const std::string& urdf_text) {
  return io::load_robot_description(test::TemporaryFile("robot.urdf", urdf_text).path());
}

AssembledModel assemble(const std::string& world, const std::string& urdf_text, const Pose2& T_world_start) {
  const test::TemporaryFile world_file("world.xml", world), urdf("robot.urdf", urdf_text);
  return assemble_model(world_file.path(), urdf.path(), io::load_robot_description(urdf.path()), T_world_start);
}

}  // namespace

std::string wheeled_urdf_text() { return test::read_bytes(kWheeledUrdf); }

WheeledRobot::WheeledRobot(const std::string& world, const std::string& urdf_text, const WheelDriveSettings& settings,
                           const WheelErrors& errors, const Pose2& T_world_start)
    : robot_(describe(urdf_text)),
      model_(assemble(world, urdf_text, T_world_start)),
      data_(make_data(*model_.physics)),
      imu_sensor_({}, *model_.physics, 1),
      encoders_(encoder_settings_, *model_.physics, robot_.joint_names, {}),
      drive_(robot_, settings, encoder_settings_.ticks_per_rad(), *model_.physics, errors),
      body_(mj_name2id(model_.physics.get(), mjOBJ_BODY, frame_id::kBody)) {
  std::copy(model_.start_qpos.begin(), model_.start_qpos.end(), data_->qpos);
  mj_forward(model_.physics.get(), data_.get());
  drive(0.0, 0.0, 1.0);
}

void WheeledRobot::advance() {
  mj_Euler(model_.physics.get(), data_.get());
  mj_forward(model_.physics.get(), data_.get());
  ++tick_;
}

WheelReport WheeledRobot::drive(double vx_mps, double yaw_rate_radps, double duration_s) {
  const VelocityCommand command{.stamp = {}, .vx_mps = vx_mps, .vy_mps = 0.0, .yaw_rate_radps = yaw_rate_radps};
  const auto travel = [this](bool is_left) {
    double sum_m = 0.0, count = 0.0;
    for (const WheelGeometry& wheel : robot_.wheels) {
      if (!wheel.drive_joint || wheel.is_left() != is_left) continue;
      const int joint = mj_name2id(model_.physics.get(), mjOBJ_JOINT, robot_.joint_names[*wheel.drive_joint].c_str());
      sum_m += wheel.forward_sign * wheel.radius_m * data_->qpos[model_.physics->jnt_qposadr[joint]];
      count += 1.0;
    }
    return sum_m / count;
  };
  const Pose3 start = T_world_body();
  const double left_m = travel(true), right_m = travel(false);
  WheelReport report;
  double last_yaw = to_yaw(start.rotation), turned = 0.0;
  const auto ticks = std::lround(duration_s / model_.physics->opt.timestep);
  for (long tick = 0; tick < ticks; ++tick) {
    const Time now = from_seconds(data_->time);
    const Imu imu = imu_sensor_.read(*model_.physics, *data_, now, tick_);
    const JointState joints = encoders_.read(*data_, now);
    drive_.step({.imu = imu, .joints = joints, .feet = {}, .ticks = {}}, command, *model_.physics, *data_);
    advance();
    const Pose3 pose = T_world_body();
    turned += wrap_angle(to_yaw(pose.rotation) - last_yaw);
    last_yaw = to_yaw(pose.rotation);
    report.max_tilt_rad =
        std::max(report.max_tilt_rad, std::acos(std::min(1.0, pose.rotation.toRotationMatrix()(2, 2))));
    for (int motor = 0; motor < model_.physics->nu; ++motor) {
      report.mean_torque_nm += data_->ctrl[motor] / static_cast<double>(ticks * model_.physics->nu);
      report.max_abs_torque_nm = std::max(report.max_abs_torque_nm, std::abs(data_->ctrl[motor]));
    }
  }
  report.moved = to_pose2(start).inverse() * to_pose2(T_world_body());
  report.moved.yaw = turned;
  report.left_m = travel(true) - left_m;
  report.right_m = travel(false) - right_m;
  return report;
}

void WheeledRobot::roll(double duration_s) {
  std::fill_n(data_->ctrl, model_.physics->nu, 0.0);
  const auto ticks = std::lround(duration_s / model_.physics->opt.timestep);
  for (long tick = 0; tick < ticks; ++tick) advance();
}

void WheeledRobot::push(double speed_mps) {
  drive(0.1, 0.0, 0.2);  // opens the brakes
  const int root = model_.physics->jnt_dofadr[model_.physics->body_jntadr[body_]];
  const Eigen::Vector3d v = T_world_body().rotation * Eigen::Vector3d(speed_mps, 0.0, 0.0);
  std::copy_n(v.data(), 3, data_->qvel + root);
  for (const WheelGeometry& wheel : robot_.wheels) {
    const int body = mj_name2id(model_.physics.get(), mjOBJ_BODY, wheel.link.c_str());
    data_->qvel[model_.physics->body_dofadr[body]] = wheel.forward_sign * speed_mps / wheel.radius_m;
  }
  mj_forward(model_.physics.get(), data_.get());
}

void WheeledRobot::lock_wheels() {
  constexpr double kLocked_nm = 1e4;
  for (const WheelGeometry& wheel : robot_.wheels) {
    const int body = mj_name2id(model_.physics.get(), mjOBJ_BODY, wheel.link.c_str());
    model_.physics->dof_frictionloss[model_.physics->body_dofadr[body]] = kLocked_nm;
  }
}

double WheeledRobot::speed_mps() const {
  const int root = model_.physics->jnt_dofadr[model_.physics->body_jntadr[body_]];
  return (T_world_body().rotation.conjugate() * Eigen::Vector3d(data_->qvel + root)).x();
}

Pose3 WheeledRobot::T_world_body() const {
  const mjtNum* position = data_->xpos + 3 * body_;
  const mjtNum* rotation = data_->xquat + 4 * body_;
  return {Eigen::Vector3d(position), Eigen::Quaterniond(rotation[0], rotation[1], rotation[2], rotation[3])};
}

}  // namespace patrol::sim
