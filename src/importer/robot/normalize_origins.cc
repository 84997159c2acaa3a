#include "importer/robot/normalize_origins.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/geometry/angles.h"
#include "importer/robot/scan_plane.h"
#include "importer/robot/surface_distance.h"
#include "sim/as_built/as_built_settings.h"

namespace patrol::importer {
namespace {

constexpr double kClear_m = 0.02;   // of the origin of beams from the robot, after it is moved
constexpr double kMaxMove_m = 0.3;  // as the size of a housing

/// Returns the distance along a direction after which a point is clear of the robot; infinite above kMaxMove_m. Sphere
/// tracing [Hart96].
double distance_until_clear_m(const RobotSurface& surface, const Eigen::Vector3d& start,
                              const Eigen::Vector3d& direction) {
  constexpr double kMinStep_m = 5e-4, kRounding_m = 1e-9;
  double moved_m = 0.0;
  while (moved_m <= kMaxMove_m) {
    const auto clearance = surface.clearance(start + moved_m * direction, kClear_m - kRounding_m);
    if (!clearance) return moved_m;
    // No point within the missing distance is clear.
    moved_m += std::max(kMinStep_m, kClear_m - clearance->distance_m);
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace

void clear_origin(const RobotLayout& layout, const std::string& frame, const std::string& link,
                  NormalizedRobot& robot) {
  if (!frame.starts_with("lidar")) return;
  NormalizedLink& sensor = robot.links.back();
  const bool has_housing = !sensor.visuals.empty() || !sensor.collisions.empty();
  RobotSurface surface;
  for (const std::string& name : layout.chassis) {
    if (has_housing && name == link) continue;
    for (const Shape& shape : layout.source.link(name).visuals) {
      if (!shape.rgba || (*shape.rgba)[3] > 0.0) surface.add(name, shape, layout.T_base(name));
    }
  }
  const Pose3 T_base_old = sensor.joint->T_parent_link;
  const double tolerance_m = sim::MountingTolerances{}.position_m;
  const auto inside = surface.clearance(T_base_old.position, std::numbers::sqrt3 * tolerance_m);
  if (!inside) return;
  const std::string key = fmt::format("mounts in {}.yaml", robot.name);
  constexpr double kAside = 3.0;  // weight of a distance to a side
  double min_weighted_m = std::numeric_limits<double>::infinity(), distance_m = 0.0;
  std::string side;
  Eigen::Vector3d move = Eigen::Vector3d::Zero();
  const std::vector<std::pair<Eigen::Vector3d, std::string>> directions = {{{0.0, 0.0, 1.0}, "up"},
                                                                           {{1.0, 0.0, 0.0}, "forward"},
                                                                           {{-1.0, 0.0, 0.0}, "back"},
                                                                           {{0.0, 1.0, 0.0}, "to the left"},
                                                                           {{0.0, -1.0, 0.0}, "to the right"}};
  for (const auto& [direction, name] : directions) {
    const double until_m = distance_until_clear_m(surface, T_base_old.position, direction);
    const double weighted_m = direction.z() > 0.0 ? until_m : kAside * until_m;
    if (weighted_m >= min_weighted_m) continue;
    min_weighted_m = weighted_m, distance_m = until_m, side = name, move = until_m * direction;
  }
  const std::string where =
      inside->distance_m <= -5e-4
          ? fmt::format("{:.3f} m inside a visual of {}", -inside->distance_m, inside->link)
          : fmt::format("only {:.3f} m from a visual of {}, and its mount has a tolerance of {:.3f} m",
                        std::max(0.0, inside->distance_m), inside->link, tolerance_m);
  if (side.empty()) {
    robot.assumptions.push_back({frame, fmt::format("its origin is {}: its beams end there", where), key});
    return;
  }
  sensor.joint->T_parent_link.position += move;
  const Pose3 T_new_old = sensor.joint->T_parent_link.inverse() * T_base_old;
  for (std::vector<NormalizedShape>* shapes : {&sensor.visuals, &sensor.collisions}) {
    for (NormalizedShape& shape : *shapes) shape.shape.T_link_shape = T_new_old * shape.shape.T_link_shape;
  }
  robot.assumptions.push_back(
      {frame,
       fmt::format("its origin is moved {} by {:.3f} m: in the file it is {}, where its beams would end", side,
                   distance_m, where),
       key});
}

void check_scan_plane(const std::string& frame, NormalizedRobot& robot) {
  if (frame != "lidar" && frame != "lidar_rear") return;
  const Pose3& T_base_lidar = robot.links.back().joint->T_parent_link;
  const double up = std::abs((T_base_lidar.rotation * Eigen::Vector3d::UnitZ()).z());
  const double tilt_deg = to_deg(std::acos(std::min(up, 1.0)));
  if (tilt_deg <= kMaxScanTilt_deg) return;
  robot.assumptions.push_back(
      {frame,
       fmt::format("its scan plane is tilted by {:.0f} degrees: mapping and navigation need a horizontal one",
                   tilt_deg),
       fmt::format("<origin rpy> of the sensor, or mounts in {}.yaml", robot.name)});
}

}  // namespace patrol::importer
