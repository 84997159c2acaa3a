#include "core/robot_description.h"

#include <algorithm>

#include "core/error.h"
#include "core/leg_kinematics.h"

namespace patrol {

double RobotDescription::outline_radius_m() const {
  double radius_m = 0.0;
  for (const Eigen::Vector2d& corner : footprint_m) radius_m = std::max(radius_m, corner.norm());
  return radius_m;
}

double RobotDescription::body_height_m() const {
  if (tracks) return tracks->body_height_m;
  double height_m = 0.0;
  for (const LegGeometry& leg : legs)
    height_m = std::max(height_m, leg.foot_radius_m - foot_position(leg, leg.standing_rad).z());
  for (const WheelGeometry& wheel : wheels) height_m = std::max(height_m, wheel.radius_m - wheel.center_in_body.z());
  return height_m;
}

const Pose3& RobotDescription::T_body(const std::string& sensor) const {
  const auto frame = T_body_sensor.find(sensor);
  if (frame == T_body_sensor.end()) throw InputError("robot " + name + ": link not found: " + sensor);
  return frame->second;
}

}  // namespace patrol
