#include "app/check/check_drive.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace patrol::app {
namespace {

/// Contacts of the hull interrupted for less than this are one contact, as for collisions of a run.
constexpr double kContactGap_s = 0.5;

sim::SimulatorSettings in_world(const CheckRobot& robot, const std::filesystem::path& world_xml) {
  sim::SimulatorSettings settings = robot.simulator;
  settings.world_xml = world_xml.string();
  return settings;
}

double tilt_of(const Pose3& T_world_body) {
  return std::acos(std::clamp(T_world_body.rotation.toRotationMatrix()(2, 2), -1.0, 1.0));
}

/// Moves a pose in the plane by a velocity for a time, by the midpoint rule.
Pose2 moved(const Pose2& pose, double forward_m, double left_m, double yaw_rad) {
  const double direction = pose.yaw + 0.5 * yaw_rad;
  return {pose.x + (forward_m * std::cos(direction) - left_m * std::sin(direction)),
          pose.y + (forward_m * std::sin(direction) + left_m * std::cos(direction)), wrap_angle(pose.yaw + yaw_rad)};
}

}  // namespace

CheckDrive::CheckDrive(const CheckRobot& robot, const std::filesystem::path& world_xml, double settle_s,
                       Observer observer)
    : observer_(std::move(observer)),
      turn_center_x_m_(robot.turn_center_x_m),
      simulator_(in_world(robot, world_xml), robot.description, robot.seed),
      probe_(robot.description, simulator_.physics()),
      last_hull_contact_s_(-std::numeric_limits<double>::infinity()) {
  tick_s_ = to_seconds(simulator_.tick());
  ticks_per_sample_ = std::max(1L, std::lround(kSamplePeriod_s / tick_s_));
  for (double time_s = 0.0; time_s < settle_s; time_s += tick_s_) {
    simulator_.step();
    simulator_.take_messages();
  }
  const Pose3 start = simulator_.truth().T_world_body;
  T_world_start_ = to_pose2(start) * Pose2{turn_center_x_m_, 0.0, 0.0};
  start_left_m_ = probe_.travel_m(simulator_.data(), true);
  start_right_m_ = probe_.travel_m(simulator_.data(), false);
  last_yaw_rad_ = to_yaw(start.rotation);
  next_.T_world_body = start;
  next_.tilt_rad = tilt_of(start);
  add_sample();
}

void CheckDrive::run(const DriveSegment& segment) {
  // A short segment never reaches the full command: its integral is that of a triangle.
  const double stop_s =
      segment.duration_s >= segment.ramp_s ? segment.duration_s : std::sqrt(segment.duration_s * segment.ramp_s);
  const double change = segment.ramp_s > 0.0 ? tick_s_ / segment.ramp_s : 1.0;
  double factor = 0.0;
  for (double time_s = 0.0; time_s < stop_s && !record_.has_fallen; time_s += tick_s_) {
    if (segment.goal_ahead_m && ahead_m() >= *segment.goal_ahead_m) break;
    factor = std::min(1.0, factor + change);
    step(factor, segment);
  }
  if (segment.is_stopped_abruptly) factor = 0.0;
  for (; factor > 0.0 && !record_.has_fallen; factor -= change) step(factor, segment);
  for (double time_s = 0.0; time_s < segment.rest_s && !record_.has_fallen; time_s += tick_s_) step(0.0, segment);
  record_.segment_ends.push_back(record_.samples.size());
}

double CheckDrive::ahead_m() const {
  return (T_world_start_.inverse() * to_pose2(simulator_.truth().T_world_body)).x + turn_center_x_m_;
}

void CheckDrive::step(double factor, const DriveSegment& segment) {
  next_.commanded_speed_mps = factor * segment.vx_mps;
  next_.commanded_lateral_mps = factor * segment.vy_mps;
  next_.commanded_yaw_rate_radps = factor * segment.yaw_rate_radps;
  simulator_.set_command({.stamp = simulator_.now(),
                          .vx_mps = next_.commanded_speed_mps,
                          .vy_mps = next_.commanded_lateral_mps,
                          .yaw_rate_radps = next_.commanded_yaw_rate_radps});
  simulator_.step();
  simulator_.take_messages();
  measure();
  if (++num_ticks_ % ticks_per_sample_ == 0) add_sample();
}

void CheckDrive::measure() {
  const GroundTruth truth = simulator_.truth();
  next_.time_s = static_cast<double>(num_ticks_ + 1) * tick_s_;
  next_.T_world_body = truth.T_world_body;
  const double yaw = to_yaw(truth.T_world_body.rotation);
  next_.yaw_rad += wrap_angle(yaw - std::exchange(last_yaw_rad_, yaw));
  next_.T_start_center = T_world_start_.inverse() * to_pose2(truth.T_world_body) * Pose2{turn_center_x_m_, 0.0, 0.0};
  const double commanded_yaw_rad = tick_s_ * next_.commanded_yaw_rate_radps;
  next_.T_start_commanded = moved(next_.T_start_commanded, tick_s_ * next_.commanded_speed_mps,
                                  tick_s_ * next_.commanded_lateral_mps, commanded_yaw_rad);
  next_.commanded_yaw_rad += commanded_yaw_rad;
  next_.speed_mps = truth.twist.linear.x();
  next_.yaw_rate_radps = truth.twist.angular.z();
  next_.ground_travel_m += tick_s_ * next_.speed_mps;
  next_.left_travel_m = probe_.travel_m(simulator_.data(), true) - start_left_m_;
  next_.right_travel_m = probe_.travel_m(simulator_.data(), false) - start_right_m_;
  const PhysicsProbe::MotorLoad load = probe_.motor_load(simulator_.data());
  next_.max_torque_ratio = std::max(next_.max_torque_ratio, load.max_torque_ratio);
  next_.mean_torque_ratio += load.mean_torque_ratio / static_cast<double>(ticks_per_sample_);
  next_.max_speed_ratio += load.max_speed_ratio / static_cast<double>(ticks_per_sample_);
  next_.tilt_rad = std::max(next_.tilt_rad, tilt_of(truth.T_world_body));
  const PhysicsProbe::GroundContact ground = probe_.ground_contact(simulator_.data());
  record_.friction = std::max(record_.friction, ground.friction);
  if (ground.is_of_hull) {
    if (next_.time_s - last_hull_contact_s_ > kContactGap_s) ++record_.num_hull_contacts;
    last_hull_contact_s_ = next_.time_s;
    record_.hull_contact_s += tick_s_;
  }
  record_.has_fallen = simulator_.has_fallen();
}

void CheckDrive::add_sample() {
  record_.samples.push_back(next_);
  next_.max_torque_ratio = next_.mean_torque_ratio = next_.max_speed_ratio = next_.tilt_rad = 0.0;
  observer_(next_.time_s);
}

}  // namespace patrol::app
