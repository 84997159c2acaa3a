#include "core/robot_description.h"

#include <algorithm>

#include "core/error.h"

namespace patrol {

double RobotDescription::outline_radius_m() const {
  double radius_m = 0.0;
  for (const Eigen::Vector2d& corner : footprint_m) radius_m = std::max(radius_m, corner.norm());
  return radius_m;
}

const Pose3& RobotDescription::T_body(const std::string& sensor) const {
  const auto frame = T_body_sensor.find(sensor);
  if (frame == T_body_sensor.end()) throw InputError("robot " + name + ": link not found: " + sensor);
  return frame->second;
}

}  // namespace patrol
