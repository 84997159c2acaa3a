#include "importer/robot/normalize_scan.h"

#include <algorithm>

#include <fmt/format.h>

namespace patrol::importer {

void choose_scan_band(const RobotLayout& layout, NormalizedRobot& robot) {
  const auto lidar = std::ranges::find(robot.links, "lidar", &NormalizedLink::name);
  if (lidar == robot.links.end() || !lidar->joint) return;
  // The firmware of legs stands at 0.7 of their length.
  constexpr double kStance = 0.7;
  const bool has_legs = layout.drive == DriveType::kLegs;
  const double ground_m = has_legs ? -kStance * robot.leg_m : layout.ground_m;
  const double height_m = lidar->joint->T_parent_link.position.z() - ground_m;
  double radius_m = 0.0;
  for (const auto& [name, T_root_link] : layout.T_root_link) {
    const SourceLink& link = layout.source.link(name);
    for (const Shape& shape : bounding_shapes(link)) {
      for (const Eigen::Vector3d& point : outline(shape))
        radius_m = std::max(radius_m, (layout.T_base(name) * point).head<2>().norm());
    }
  }
  robot.scan_band = scan_band_of(height_m, radius_m);
  if (!robot.scan_band) return;
  robot.assumptions.push_back(
      {"lidar",
       fmt::format("is {:.2f} m above the ground: its hits are obstacles above {:.2f} m (default {:.2f} m), and it "
                   "ignores them within {:.2f} m of the middle of the robot (default {:.2f} m)",
                   height_m, robot.scan_band->min_height_m, kDefaultMinHitHeight_m,
                   robot.scan_band->self_filter_radius_m, kDefaultSelfFilterRadius_m),
       fmt::format("stack.scan_leveling in {}.yaml", robot.name)});
}

}  // namespace patrol::importer
