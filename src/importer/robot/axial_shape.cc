#include "importer/robot/axial_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include <Eigen/Core>

namespace patrol::importer {
namespace {

constexpr double kRoundness = 0.035;  // a regular polygon of twelve sides is round
constexpr double kRim = 0.9;          // to the radius: the surface farther out is the tire, closer to the axle the hub

/// Returns whether points have the same extent in all directions across the z axis.
bool is_round_about_z(const std::vector<Eigen::Vector3d>& points) {
  constexpr int kNumDirections = 72;
  double min_extent = std::numeric_limits<double>::infinity(), max_extent = 0.0;
  for (int i = 0; i < kNumDirections; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kNumDirections;
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    double extent = -std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& p : points) extent = std::max(extent, direction.dot(p.head<2>()));
    min_extent = std::min(min_extent, extent);
    max_extent = std::max(max_extent, extent);
  }
  return max_extent > 0.0 && max_extent - min_extent <= kRoundness * max_extent;
}

/// Returns the point at which a segment meets the cylinder about the z axis, from a point outside to a point inside.
Eigen::Vector3d entry_point(const Eigen::Vector3d& outside, const Eigen::Vector3d& inside, double radius_m) {
  const Eigen::Vector2d start = outside.head<2>(), along = (inside - outside).head<2>();
  const double a = along.squaredNorm(), b = start.dot(along), c = start.squaredNorm() - radius_m * radius_m;
  return outside + (-b - std::sqrt(std::max(0.0, b * b - a * c))) / a * (inside - outside);
}

/// Sets the extent of the edges of a mesh at a distance from the axis of at least kRim times the radius.
void measure_rim(const std::vector<Eigen::Vector3d>& points, const Mesh& mesh, AxialShape& result) {
  const double rim_m = kRim * result.radius_m;
  const auto is_outside = [rim_m](const Eigen::Vector3d& point) { return point.head<2>().norm() >= rim_m; };
  result.rim_min_m = std::numeric_limits<double>::infinity();
  result.rim_max_m = -result.rim_min_m;
  const auto add = [&result](const Eigen::Vector3d& point) {
    result.rim_min_m = std::min(result.rim_min_m, point.z());
    result.rim_max_m = std::max(result.rim_max_m, point.z());
  };
  for (const Eigen::Vector3d& point : points) {
    if (is_outside(point)) add(point);
  }
  for (const std::array<int, 3>& triangle : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d& a = points[static_cast<std::size_t>(triangle[k])];
      const Eigen::Vector3d& b = points[static_cast<std::size_t>(triangle[(k + 1) % 3])];
      if (is_outside(a) != is_outside(b)) add(is_outside(a) ? entry_point(a, b, rim_m) : entry_point(b, a, rim_m));
    }
  }
}

}  // namespace

AxialShape axial_shape(const Shape& shape, const Pose3& T_axis_link) {
  AxialShape result;
  const Pose3 T_axis_shape = T_axis_link * shape.T_link_shape;
  const double offset_m = T_axis_shape.position.head<2>().norm();
  const bool is_centered = offset_m <= kRoundness * shape.radius_m;
  const bool is_parallel = std::abs((T_axis_shape.rotation * Eigen::Vector3d::UnitZ()).z()) > 0.9985;
  if ((shape.type == ShapeType::kCylinder && is_centered && is_parallel) ||
      (shape.type == ShapeType::kSphere && is_centered)) {
    result.is_round = true;
    result.is_sphere = shape.type == ShapeType::kSphere;
    result.radius_m = shape.radius_m;
    const double half_m = result.is_sphere ? shape.radius_m : 0.5 * shape.length_m;
    result.min_m = T_axis_shape.position.z() - half_m;
    result.max_m = T_axis_shape.position.z() + half_m;
    result.rim_min_m = result.min_m;
    result.rim_max_m = result.max_m;
    return result;
  }
  std::vector<Eigen::Vector3d> points = outline(shape);
  for (Eigen::Vector3d& point : points) point = T_axis_link * point;
  result.min_m = std::numeric_limits<double>::infinity();
  result.max_m = -result.min_m;
  for (const Eigen::Vector3d& point : points) {
    result.radius_m = std::max(result.radius_m, point.head<2>().norm());
    result.min_m = std::min(result.min_m, point.z());
    result.max_m = std::max(result.max_m, point.z());
  }
  result.rim_min_m = result.min_m;
  result.rim_max_m = result.max_m;
  result.is_round = shape.type == ShapeType::kMesh && is_round_about_z(points);
  if (result.is_round) measure_rim(points, whole_mesh(shape), result);
  return result;
}

std::optional<AxialShape> round_hull(const std::vector<AxialShape>& shapes) {
  std::optional<AxialShape> wheel;
  double max_other_m = 0.0;
  for (const AxialShape& shape : shapes) {
    if (!shape.is_round) max_other_m = std::max(max_other_m, shape.radius_m);
    else if (!wheel || shape.radius_m > wheel->radius_m) wheel = shape;
  }
  if (!wheel || max_other_m > 1.1 * wheel->radius_m) return std::nullopt;
  for (const AxialShape& shape : shapes) {
    if (!shape.is_round || shape.radius_m < 0.97 * wheel->radius_m) continue;
    wheel->rim_min_m = std::min(wheel->rim_min_m, shape.rim_min_m);
    wheel->rim_max_m = std::max(wheel->rim_max_m, shape.rim_max_m);
    wheel->is_sphere = wheel->is_sphere && shape.is_sphere;
  }
  return wheel;
}

}  // namespace patrol::importer
