#include "sim/locomotion/track_contact.h"

#include <algorithm>
#include <string>
#include <string_view>

#include "core/error.h"
#include "sim/mujoco.h"

namespace patrol::sim {
namespace {

using RotationOfGeom = Eigen::Map<const Eigen::Matrix<mjtNum, 3, 3, Eigen::RowMajor>>;

Eigen::Vector3d across(const mjModel& model, int geom) {
  const mjtNum* q = model.geom_quat + 4 * geom;
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).conjugate() * Eigen::Vector3d::UnitY();
}

}  // namespace

TrackContact::TrackContact(const RobotDescription& robot, double friction, mjModel& physics, const TrackErrors& errors)
    : wheel_of_geom_(static_cast<std::size_t>(physics.ngeom), -1) {
  constexpr std::array<std::string_view, 2> kWheelNames = {"left_wheel_", "right_wheel_"};
  for (int geom = 0; geom < physics.ngeom; ++geom) {
    const std::string_view name = name_of(physics, mjOBJ_GEOM, geom);
    for (std::size_t side = 0; side < kWheelNames.size(); ++side) {
      if (!name.starts_with(kWheelNames[side])) continue;
      const double sprocket_radius_m = robot.tracks->sprocket_radius_m * errors.sprocket_scale[side];
      const double turns = sprocket_radius_m / physics.geom_size[3 * geom];
      wheel_of_geom_[static_cast<std::size_t>(geom)] = static_cast<int>(wheels_.size());
      wheels_.push_back({.geom = geom, .side = side, .rate_per_radps = turns * across(physics, geom)});
      physics.geom_friction[3 * geom] = friction * errors.friction_scale;
    }
  }
  for (std::size_t side = 0; side < sprocket_dofs_.size(); ++side) {
    const int joint = mj_name2id(&physics, mjOBJ_JOINT, robot.joint_names.at(side).c_str());
    if (joint < 0 || wheels_.empty())
      throw InputError("robot " + robot.name + ": physics model lacks the robot's tracks");
    sprocket_dofs_[side] = physics.jnt_dofadr[joint];
  }
  physics.flg_surfacevel = true;
}

void TrackContact::run(mjModel& physics, const mjData& data) const {
  for (const Wheel& wheel : wheels_) {
    const int dof = sprocket_dofs_[wheel.side];
    const double sprocket_radps = data.qvel[dof] + physics.opt.timestep * data.qacc[dof];
    const Eigen::Vector3d rate = sprocket_radps * wheel.rate_per_radps;
    std::copy_n(rate.data(), 3, physics.geom_surfacevel + 6 * wheel.geom + 3);
  }
}

std::array<double, 2> TrackContact::contact_torque_nm(const mjModel& physics, const mjData& data) const {
  std::array<double, 2> drag{};
  for (int i = 0; i < data.ncon; ++i) {
    const mjContact& contact = data.contact[i];
    if (contact.efc_address < 0) continue;
    for (int which = 0; which < 2; ++which) {
      const int index = wheel_of_geom_[static_cast<std::size_t>(contact.geom[which])];
      if (index < 0) continue;
      const Wheel& wheel = wheels_[static_cast<std::size_t>(index)];
      mjtNum force[6];  // normal force, two tangential forces; on the second geom
      mj_contactForce(&physics, &data, i, force);
      const Eigen::Vector3d rate = RotationOfGeom(data.geom_xmat + 9 * wheel.geom) * wheel.rate_per_radps;
      const Eigen::Vector3d arm = Eigen::Vector3d(contact.pos) - Eigen::Vector3d(data.geom_xpos + 3 * wheel.geom);
      const Eigen::Vector3d surface = rate.cross(arm);  // m/s per rad/s of the sprocket
      const double pull = force[1] * surface.dot(Eigen::Vector3d(contact.frame + 3)) +
                          force[2] * surface.dot(Eigen::Vector3d(contact.frame + 6));
      drag[wheel.side] += which == 1 ? pull : -pull;
    }
  }
  return drag;
}

}  // namespace patrol::sim
