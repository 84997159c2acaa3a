#include "importer/robot/robot_layout.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace patrol::importer {

std::vector<const SourceLink*> RobotLayout::moving_group(const SourceJoint& joint) const {
  return rigid_group(source, joint.child, kept);
}

bool RobotLayout::is_near_ground(double bottom_m) const {
  double max_radius_m = 0.0;
  for (const FoundWheel& wheel : found.wheels) max_radius_m = std::max(max_radius_m, wheel.radius_m);
  return std::abs(bottom_m - ground_m) <= 0.02 * max_radius_m + 0.005;
}

double axle_angle_rad(const Eigen::Vector3d& axis) {
  double angle = std::atan2(-axis.x(), axis.y());
  if (angle <= -0.5 * std::numbers::pi + 1e-9) angle += std::numbers::pi;
  if (angle > 0.5 * std::numbers::pi + 1e-9) angle -= std::numbers::pi;
  return angle;
}

SourceExtent measure_extent(const RobotLayout& layout) {
  SourceExtent extent;
  for (const SourceLink& link : layout.source.links) {
    extent.mass_kg += link.inertial ? link.inertial->mass_kg : 0.0;
    for (const std::vector<Shape>* shapes : {&link.collisions, &link.visuals}) {
      for (const Shape& shape : *shapes) {
        for (const Eigen::Vector3d& point : outline(shape)) extent.box.extend(layout.T_root_link.at(link.name) * point);
      }
    }
  }
  return extent;
}

void check_centers(const RobotLayout& layout) {
  if (layout.extent.box.isEmpty()) return;
  const double size_m = layout.extent.box.diagonal().norm();
  for (const SourceLink& link : layout.source.links) {
    if (!link.inertial || link.inertial->mass_kg <= 0.0) continue;
    const double outside_m =
        layout.extent.box.exteriorDistance(layout.T_root_link.at(link.name) * link.inertial->T_link_inertia.position);
    if (outside_m <= size_m) continue;
    layout.source.fail(
        link.inertial->line, link.name,
        fmt::format("center of mass is {:.3g} m outside the shapes of a robot of {:.3g} m: check <origin>", outside_m,
                    size_m));
  }
}

}  // namespace patrol::importer
