#include "tests/support/simulated_tracked_robot.h"

#include <algorithm>
#include <cmath>

#include "io/urdf.h"
#include "tests/support/temporary_file.h"

namespace patrol::sim {
namespace {

AssembledModel assemble_tracked(const std::string& world, const Pose2& T_world_start) {
  const test::TemporaryFile file("world.xml", world);
  return assemble_model(file.path(), kTrackedUrdf, io::load_robot_description(kTrackedUrdf), T_world_start);
}

double tilt_from_gravity(const Pose3& pose) { return std::acos(std::min(1.0, pose.rotation.toRotationMatrix()(2, 2))); }

}  // namespace

RobotDescription tracked_description() { return io::load_robot_description(kTrackedUrdf); }

TrackedRobot::TrackedRobot(const std::string& world, const Pose2& T_world_start, const TrackDriveSettings& settings,
                           const RobotDescription& robot, std::uint64_t seed, bool uses_nearby_scenery)
    : robot_(robot),
      model_(assemble_tracked(world, T_world_start)),
      data_(make_data(*model_.physics)),
      imu_sensor_({}, *model_.physics, seed),
      hall_(hall_settings_, *model_.physics, robot_.joint_names, seed),
      drive_(robot_, settings, hall_settings_.ticks_per_rad(), *model_.physics),
      body_(mj_name2id(model_.physics.get(), mjOBJ_BODY, frame_id::kBody)) {
  if (uses_nearby_scenery) culler_.emplace(*model_.physics);
  std::copy(model_.start_qpos.begin(), model_.start_qpos.end(), data_->qpos);
  mj_forward(model_.physics.get(), data_.get());
  stand(1.0);
}

void TrackedRobot::command_drive(const VelocityCommand& command) {
  const Time now = from_seconds(data_->time);
  imu_ = imu_sensor_.read(*model_.physics, *data_, now, tick_);
  ticks_ = hall_.read(*data_, now);
  drive_.step({.imu = imu_, .joints = {}, .feet = {}, .ticks = ticks_}, command, *model_.physics, *data_);
}

void TrackedRobot::advance() {
  mj_Euler(model_.physics.get(), data_.get());
  if (culler_) culler_->update(*data_);
  mj_forward(model_.physics.get(), data_.get());
  ++tick_;
}

DriveReport TrackedRobot::drive(double vx_mps, double yaw_rate_radps, double duration_s) {
  const VelocityCommand command{.stamp = {}, .vx_mps = vx_mps, .vy_mps = 0.0, .yaw_rate_radps = yaw_rate_radps};
  const Pose3 start = T_world_body();
  const TrackTicks ticks_at_start = ticks_;
  const auto ticks = static_cast<int>(std::lround(duration_s / model_.physics->opt.timestep));
  DriveReport report;
  double last_yaw = to_yaw(start.rotation), turned = 0.0;
  for (int tick = 0; tick < ticks; ++tick) {
    step(command);
    const Pose3 pose = T_world_body();
    turned += wrap_angle(to_yaw(pose.rotation) - last_yaw);
    last_yaw = to_yaw(pose.rotation);
    report.max_tilt_rad = std::max(report.max_tilt_rad, tilt_from_gravity(pose));
    report.mean_left_nm += data_->ctrl[0] / ticks;
    report.mean_right_nm += data_->ctrl[1] / ticks;
    report.mean_contacts += static_cast<double>(data_->ncon) / ticks;
  }
  report.moved = to_pose2(start).inverse() * to_pose2(T_world_body());
  report.moved.yaw = turned;
  report.climbed_m = T_world_body().position.z() - start.position.z();
  const double m_per_tick = robot_.tracks->sprocket_radius_m / hall_settings_.ticks_per_rad();
  report.left_belt_m = static_cast<double>(ticks_.left - ticks_at_start.left) * m_per_tick;
  report.right_belt_m = static_cast<double>(ticks_.right - ticks_at_start.right) * m_per_tick;
  report.has_fallen = drive_.has_fallen();
  return report;
}

double TrackedRobot::force_on_n(const std::string& geom) const {
  const int id = mj_name2id(model_.physics.get(), mjOBJ_GEOM, geom.c_str());
  double sum = 0.0;
  for (int i = 0; i < data_->ncon; ++i) {
    if (data_->contact[i].geom[0] != id && data_->contact[i].geom[1] != id) continue;
    mjtNum force[6];  // normal first
    mj_contactForce(model_.physics.get(), data_.get(), i, force);
    sum += force[0];
  }
  return sum;
}

Pose3 TrackedRobot::T_world_body() const {
  const mjtNum* position = data_->xpos + 3 * body_;
  const mjtNum* rotation = data_->xquat + 4 * body_;
  return {Eigen::Vector3d(position), Eigen::Quaterniond(rotation[0], rotation[1], rotation[2], rotation[3])};
}

}  // namespace patrol::sim
