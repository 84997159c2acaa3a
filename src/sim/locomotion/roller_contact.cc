#include "sim/locomotion/roller_contact.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/wheel_kinematics.h"

namespace patrol::sim {
namespace {

constexpr double kMaxSideCosine = 0.9;  // a contact whose normal is closer to the axle is on the side of the wheel

}  // namespace

void set_drive_type(const WheelDriveSettings& settings, RobotDescription& robot) {
  if (settings.type != "mecanum") return;
  validate(settings, "wheel_drive");
  try {
    add_rollers(settings.roller_pattern == "x" ? RollerPattern::kX : RollerPattern::kO, settings.roller_angle_rad,
                robot);
  } catch (const InputError& error) {
    throw InputError(fmt::format("wheel_drive.type = mecanum: {}", error.what()));
  }
}

RollerContact::RollerContact(const RobotDescription& robot, const WheelDriveSettings& settings, const mjModel& physics)
    : wheel_of_geom_(static_cast<std::size_t>(physics.ngeom), -1), roller_friction_(settings.roller_friction) {
  for (const WheelGeometry& wheel : robot.wheels) {
    if (!wheel.roller_axis_rad) continue;
    const int geom = mj_name2id(&physics, mjOBJ_GEOM, wheel.link.c_str());
    if (geom < 0) throw InputError("robot " + robot.name + ": the physics model lacks the wheel " + wheel.link);
    wheel_of_geom_[static_cast<std::size_t>(geom)] = static_cast<int>(wheels_.size());
    wheels_.push_back(
        {.carrier = physics.body_rootid[physics.geom_bodyid[geom]], .roller_axis_rad = *wheel.roller_axis_rad});
  }
}

// Constraints are a function of the contacts. They are made twice, so that all else is exactly what mj_forward does.
void RollerContact::evaluate(const mjModel& physics, mjData& data) const {
  mj_fwdPosition(&physics, &data);
  for (int i = 0; i < data.ncon; ++i) {
    mjContact& contact = data.contact[i];
    for (int which = 0; which < 2; ++which) {
      const int geom = contact.geom[which];
      const int index = geom < 0 ? -1 : wheel_of_geom_[static_cast<std::size_t>(geom)];
      if (index >= 0) set_friction(data, contact, wheels_[static_cast<std::size_t>(index)], which == 0);
    }
  }
  mj_makeConstraint(&physics, &data);
  mj_island(&physics, &data);
  mj_projectConstraint(&physics, &data);
  mj_sensorPos(&physics, &data);
  mj_forwardSkip(&physics, &data, mjSTAGE_POS, 0);
}

// With the upward normal n below a wheel and the axle y, t = y x n points forward, and the axis of the roller is
// cos(a) t + sin(a) y. The same holds in the frame of every other roller that touches.
void RollerContact::set_friction(const mjData& data, mjContact& contact, const Wheel& wheel, bool is_first) const {
  using Rotation = Eigen::Map<const Eigen::Matrix<mjtNum, 3, 3, Eigen::RowMajor>>;
  const Eigen::Vector3d normal(contact.frame);
  const Eigen::Vector3d toward_wheel = is_first ? Eigen::Vector3d(-normal) : normal;
  const Eigen::Vector3d axle = Rotation(data.xmat + 9 * wheel.carrier).col(1);
  if (std::abs(axle.dot(normal)) > kMaxSideCosine) return;
  const Eigen::Vector3d forward = axle.cross(toward_wheel).normalized();
  const Eigen::Vector3d lateral = toward_wheel.cross(forward);
  const Eigen::Vector3d axis = std::cos(wheel.roller_axis_rad) * forward + std::sin(wheel.roller_axis_rad) * lateral;
  const Eigen::Vector3d across = normal.cross(axis);
  std::copy_n(axis.data(), 3, contact.frame + 3);
  std::copy_n(across.data(), 3, contact.frame + 6);
  contact.friction[1] = std::min(roller_friction_, contact.friction[0]);
}

}  // namespace patrol::sim
