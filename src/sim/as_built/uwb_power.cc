#include "sim/as_built/uwb_power.h"

#include <cmath>

#include "core/random.h"

namespace patrol::sim {

double UwbPower::offset_db(int anchor, const Eigen::Vector3d& anchor_to_robot) const {
  if (std_db_ == 0.0) return 0.0;
  const RandomStream gains(seed_, "as_built/uwb/received_power");
  const double robot = gains.normal(0);
  const auto anchor_gains = gains.normals(1, static_cast<std::uint64_t>(anchor));
  // Sine and cosine terms of unit variance together.
  const double across_m = std::hypot(anchor_to_robot.x(), anchor_to_robot.y());
  const double pattern =
      across_m > 0.0 ? (anchor_gains[1] * anchor_to_robot.x() + anchor_gains[2] * anchor_to_robot.y()) / across_m : 0.0;
  return std_db_ * (robot + anchor_gains[0] + pattern);
}

}  // namespace patrol::sim
