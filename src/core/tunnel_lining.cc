#include "core/tunnel_lining.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/angles.h"

namespace patrol {
namespace {

/// Returns the pose of an axis element at a distance along it.
Pose2 pose_along(const Pose2& start, double curvature_1pm, double distance_m) {
  const double turn = curvature_1pm * distance_m;
  if (std::abs(turn) < 1e-12) return start * Pose2{distance_m, 0.0, 0.0};
  return start * Pose2{std::sin(turn) / curvature_1pm, (1.0 - std::cos(turn)) / curvature_1pm, turn};
}

}  // namespace

Eigen::Vector2d TunnelLining::point_at(double chainage_m, double left_m) const {
  Pose2 start = T_route_start;
  double remaining_m = chainage_m;
  for (std::size_t i = 0; i < axis.size(); ++i) {
    if (remaining_m <= axis[i].length_m || i + 1 == axis.size()) {
      return (pose_along(start, axis[i].curvature_1pm, remaining_m) * Pose2{0.0, left_m, 0.0}).position();
    }
    start = pose_along(start, axis[i].curvature_1pm, axis[i].length_m);
    remaining_m -= axis[i].length_m;
  }
  return (start * Pose2{remaining_m, left_m, 0.0}).position();
}

double TunnelLining::heading_at(double chainage_m) const {
  double yaw = T_route_start.yaw, remaining_m = chainage_m;
  for (std::size_t i = 0; i < axis.size(); ++i) {
    const double distance_m = i + 1 == axis.size() ? remaining_m : std::min(remaining_m, axis[i].length_m);
    yaw += axis[i].curvature_1pm * distance_m;
    remaining_m -= distance_m;
    if (remaining_m <= 0.0) break;
  }
  return wrap_angle(yaw);
}

TunnelCoordinates TunnelLining::to_tunnel_coordinates(const Eigen::Vector3d& p_route) const {
  TunnelCoordinates nearest{.height_m = p_route.z()};
  double min_outside_m = std::numeric_limits<double>::infinity();
  Pose2 start = T_route_start;
  double begin_m = 0.0;
  for (std::size_t i = 0; i < axis.size(); ++i) {
    const auto& [length_m, curvature_1pm] = axis[i];
    const Eigen::Vector2d p = start.inverse() * Eigen::Vector2d(p_route.head<2>());
    double distance_m = p.x(), left_m = p.y();
    if (curvature_1pm != 0.0) {
      const double radius_m = 1.0 / curvature_1pm, sign = curvature_1pm > 0.0 ? 1.0 : -1.0;
      distance_m = std::atan2(sign * p.x(), sign * (radius_m - p.y())) * radius_m;
      left_m = radius_m - sign * std::hypot(p.x(), radius_m - p.y());
    }
    const bool is_first = i == 0, is_last = i + 1 == axis.size();
    const double before_m = is_first ? 0.0 : std::max(0.0, -distance_m),
                 after_m = is_last ? 0.0 : std::max(0.0, distance_m - length_m);
    if (const double outside_m = before_m + after_m + std::abs(left_m) * 1e-9; outside_m < min_outside_m) {
      min_outside_m = outside_m;
      nearest.chainage_m = begin_m + distance_m;
      nearest.left_m = left_m;
    }
    if (is_last) break;
    start = pose_along(start, curvature_1pm, length_m);
    begin_m += length_m;
  }
  return nearest;
}

int TunnelLining::ring_at(double chainage_m) const {
  const double ring = std::floor((chainage_m - first_ring_m) / ring_length_m) + 1.0;
  return ring >= 1.0 && ring <= rings ? static_cast<int>(ring) : 0;
}

double TunnelLining::clock_deg(const TunnelCoordinates& coordinates) const {
  const double angle = std::atan2(-coordinates.left_m, coordinates.height_m - crown_center_m) / kDegree;
  return angle < 0.0 ? angle + 360.0 : angle;
}

double TunnelLining::radius_at(double clock_deg) const {
  const double across = std::abs(std::sin(clock_deg * kDegree)), up = std::cos(clock_deg * kDegree);
  if (up >= 0.0) return crown_radius_m;
  // The circle of a side wall has its center beyond the axis, at the height of the center of the half circle.
  const double beyond_m = side_radius_m - crown_radius_m;
  return -beyond_m * across + std::sqrt(side_radius_m * side_radius_m - beyond_m * beyond_m * (1.0 - across * across));
}

Eigen::Vector3d TunnelLining::intrados(double chainage_m, double clock_deg) const {
  const double radius_m = radius_at(clock_deg);
  const Eigen::Vector2d p = point_at(chainage_m, -radius_m * std::sin(clock_deg * kDegree));
  return {p.x(), p.y(), crown_center_m + radius_m * std::cos(clock_deg * kDegree)};
}

}  // namespace patrol
