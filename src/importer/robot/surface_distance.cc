#include "importer/robot/surface_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>

namespace patrol::importer {
namespace {

using Corners = std::array<Eigen::Vector3d, 3>;

/// Returns the distance of the origin from a segment.
double segment_distance_m(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d along = b - a;
  const double length2 = along.squaredNorm();
  const double part = length2 > 0.0 ? std::clamp(-a.dot(along) / length2, 0.0, 1.0) : 0.0;
  return (a + part * along).norm();
}

/// Returns the distance of the origin from a triangle.
double triangle_distance_m(const Corners& p) {
  const Eigen::Vector3d normal = (p[1] - p[0]).cross(p[2] - p[0]);
  bool is_above = normal.squaredNorm() > 0.0;
  double distance_m = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector3d &a = p[k], &b = p[(k + 1) % 3];
    is_above = is_above && normal.dot((b - a).cross(-a)) >= 0.0;
    distance_m = std::min(distance_m, segment_distance_m(a, b));
  }
  return is_above ? std::abs(normal.normalized().dot(p[0])) : distance_m;
}

/// Returns the solid angle of a triangle seen from the origin, positive from inside [Oosterom83].
double solid_angle_sr(const Corners& p) {
  const std::array<double, 3> r = {p[0].norm(), p[1].norm(), p[2].norm()};
  const double volume = p[0].dot(p[1].cross(p[2]));
  return 2.0 *
         std::atan2(volume, r[0] * r[1] * r[2] + p[0].dot(p[1]) * r[2] + p[1].dot(p[2]) * r[0] + p[2].dot(p[0]) * r[1]);
}

/// Returns the signed distance of a point from a mesh. Inside: the triangles cover more than half of the sphere of
/// directions, which also holds in a mesh with gaps.
double mesh_distance_m(const Mesh& mesh, const Eigen::Vector3d& point) {
  double distance_m = std::numeric_limits<double>::infinity(), covered_sr = 0.0;
  for (const std::array<int, 3>& triangle : mesh.triangles) {
    Corners corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = mesh.vertices_m[static_cast<std::size_t>(triangle[k])] - point;
    distance_m = std::min(distance_m, triangle_distance_m(corners));
    covered_sr += solid_angle_sr(corners);
  }
  return std::abs(covered_sr) > 2.0 * std::numbers::pi ? -distance_m : distance_m;
}

/// Returns the signed distance of a point in the frame of a box from its surface.
double box_distance_m(const Eigen::Vector3d& size_m, const Eigen::Vector3d& point) {
  const Eigen::Vector3d beyond = point.cwiseAbs() - 0.5 * size_m;
  return beyond.cwiseMax(0.0).norm() + std::min(beyond.maxCoeff(), 0.0);
}

/// Returns the signed distance of a point in the frame of a cylinder from its surface.
double cylinder_distance_m(double radius_m, double length_m, const Eigen::Vector3d& point) {
  const Eigen::Vector2d beyond(point.head<2>().norm() - radius_m, std::abs(point.z()) - 0.5 * length_m);
  return beyond.cwiseMax(0.0).norm() + std::min(beyond.maxCoeff(), 0.0);
}

}  // namespace

void RobotSurface::add(const std::string& link, const Shape& shape, const Pose3& T_base_link) {
  Part part{.link = link, .shape = shape, .mesh = {}, .box = {}};
  part.shape.T_link_shape = T_base_link * shape.T_link_shape;
  for (const Eigen::Vector3d& point : outline(part.shape)) part.box.extend(point);
  if (shape.type == ShapeType::kMesh) part.mesh = transformed(whole_mesh(shape), part.shape.T_link_shape);
  parts_.push_back(std::move(part));
}

std::optional<RobotSurface::Clearance> RobotSurface::clearance(const Eigen::Vector3d& p_base, double max_m) const {
  std::optional<Clearance> nearest;
  for (const Part& part : parts_) {
    if (part.box.exteriorDistance(p_base) >= max_m) continue;
    const Eigen::Vector3d p_shape = part.shape.T_link_shape.inverse() * p_base;
    double distance_m = 0.0;
    switch (part.shape.type) {
      case ShapeType::kBox:
        distance_m = box_distance_m(part.shape.size_m, p_shape);
        break;
      case ShapeType::kCylinder:
        distance_m = cylinder_distance_m(part.shape.radius_m, part.shape.length_m, p_shape);
        break;
      case ShapeType::kSphere:
        distance_m = p_shape.norm() - part.shape.radius_m;
        break;
      case ShapeType::kMesh:
        distance_m = mesh_distance_m(part.mesh, p_base);
        break;
    }
    if (distance_m < max_m && (!nearest || distance_m < nearest->distance_m))
      nearest = Clearance{distance_m, part.link};
  }
  return nearest;
}

}  // namespace patrol::importer
