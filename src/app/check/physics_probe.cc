#include "app/check/physics_probe.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/frames.h"
#include "sim/mujoco.h"

namespace patrol::app {
namespace {

int find(const mjModel& physics, mjtObj type, const std::string& name, const RobotDescription& robot) {
  const int id = mj_name2id(&physics, type, name.c_str());
  if (id < 0) throw InputError(fmt::format("robot {}: the physics model lacks {}", robot.name, name));
  return id;
}

bool is_steering(const RobotDescription& robot, std::size_t joint) {
  return std::any_of(robot.wheels.begin(), robot.wheels.end(),
                     [&](const WheelGeometry& wheel) { return wheel.steering_joint == joint; });
}

bool is_footing(const RobotDescription& robot, std::string_view geom) {
  if (robot.tracks) return geom.starts_with("left_wheel_") || geom.starts_with("right_wheel_");
  const auto is_wheel = [&](const WheelGeometry& wheel) { return geom == wheel.link; };
  const auto is_foot = [&](const LegGeometry& leg) { return geom == leg.foot_link; };
  return std::any_of(robot.wheels.begin(), robot.wheels.end(), is_wheel) ||
         std::any_of(robot.legs.begin(), robot.legs.end(), is_foot);
}

}  // namespace

PhysicsProbe::PhysicsProbe(const RobotDescription& robot, const mjModel& physics)
    : physics_(physics), robot_root_(find(physics, mjOBJ_BODY, frame_id::kBody, robot)) {
  for (std::size_t i = 0; i < robot.joint_names.size(); ++i) {
    if (is_steering(robot, i)) continue;
    const std::string& name = robot.joint_names[i];
    motors_.push_back({.actuator = find(physics, mjOBJ_ACTUATOR, name, robot),
                       .dof = physics.jnt_dofadr[find(physics, mjOBJ_JOINT, name, robot)],
                       .max_torque_nm = robot.joint_limits.at(i).effort_nm,
                       .max_speed_radps = robot.joint_limits.at(i).velocity_radps});
  }
  const auto qpos_of = [&](std::size_t joint) {
    return physics.jnt_qposadr[find(physics, mjOBJ_JOINT, robot.joint_names.at(joint), robot)];
  };
  if (robot.tracks) {
    for (const std::size_t side : {0, 1})
      rollers_.push_back({.qpos = qpos_of(side), .is_left = side == 0, .m_per_rad = robot.tracks->sprocket_radius_m});
  }
  for (const WheelGeometry& wheel : robot.wheels) {
    if (!wheel.drive_joint) continue;
    rollers_.push_back({.qpos = qpos_of(*wheel.drive_joint),
                        .is_left = wheel.is_left(),
                        .m_per_rad = wheel.forward_sign * wheel.radius_m});
  }
  for (int geom = 0; geom < physics.ngeom; ++geom) {
    if (is_footing(robot, sim::name_of(physics, mjOBJ_GEOM, geom))) footing_.insert(geom);
  }
}

PhysicsProbe::MotorLoad PhysicsProbe::motor_load(const mjData& data) const {
  MotorLoad load;
  for (const Motor& motor : motors_) {
    const double torque_ratio = std::abs(data.actuator_force[motor.actuator]) / motor.max_torque_nm;
    load.max_torque_ratio = std::max(load.max_torque_ratio, torque_ratio);
    load.mean_torque_ratio += torque_ratio / static_cast<double>(motors_.size());
    load.max_speed_ratio = std::max(load.max_speed_ratio, std::abs(data.qvel[motor.dof]) / motor.max_speed_radps);
  }
  return load;
}

double PhysicsProbe::travel_m(const mjData& data, bool is_left) const {
  double sum_m = 0.0, count = 0.0;
  for (const Roller& roller : rollers_) {
    if (roller.is_left != is_left) continue;
    sum_m += roller.m_per_rad * data.qpos[roller.qpos];
    count += 1.0;
  }
  return count > 0.0 ? sum_m / count : 0.0;
}

PhysicsProbe::GroundContact PhysicsProbe::ground_contact(const mjData& data) const {
  GroundContact ground;
  const auto is_robot = [&](int geom) { return physics_.body_rootid[physics_.geom_bodyid[geom]] == robot_root_; };
  for (int i = 0; i < data.ncon; ++i) {
    const mjContact& contact = data.contact[i];
    int robot_geom = contact.geom[0], other = contact.geom[1];
    if (!is_robot(robot_geom)) std::swap(robot_geom, other);
    if (!is_robot(robot_geom) || is_robot(other) || contact.efc_address < 0) continue;
    if (footing_.contains(robot_geom)) ground.friction = std::max(ground.friction, contact.friction[0]);
    else ground.is_of_hull = true;
  }
  return ground;
}

}  // namespace patrol::app
