#include <cmath>
#include <numbers>

#include "importer/hull.h"
#include "importer/robot/source_robot.h"

namespace patrol::importer {
namespace {

constexpr int kNumOnOutline = 48;

void add_ring(const Shape& shape, double z_m, std::vector<Eigen::Vector3d>& points) {
  const double radius_m = shape.radius_m / std::cos(std::numbers::pi / kNumOnOutline);
  for (int i = 0; i < kNumOnOutline; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kNumOnOutline;
    points.push_back(shape.T_link_shape * Eigen::Vector3d(radius_m * std::cos(angle), radius_m * std::sin(angle), z_m));
  }
}

void add_sphere(const Shape& shape, std::vector<Eigen::Vector3d>& points) {
  constexpr int kNumRows = 12;
  for (int row = 0; row <= kNumRows; ++row) {
    const double polar = std::numbers::pi * row / kNumRows;
    const double z_m = shape.radius_m * std::cos(polar), ring_m = shape.radius_m * std::sin(polar);
    for (int i = 0; i < kNumOnOutline / 2; ++i) {
      const double angle = 4.0 * std::numbers::pi * i / kNumOnOutline;
      points.emplace_back(shape.T_link_shape.position +
                          Eigen::Vector3d(ring_m * std::cos(angle), ring_m * std::sin(angle), z_m));
    }
  }
}

/// Returns the properties of a shape in its own frame.
SolidProperties local_solid(const Shape& shape) {
  SolidProperties solid;
  Eigen::Vector3d moments = Eigen::Vector3d::Zero();
  switch (shape.type) {
    case ShapeType::kBox: {
      const Eigen::Vector3d squares = shape.size_m.cwiseProduct(shape.size_m);
      solid.volume_m3 = shape.size_m.prod();
      moments = (Eigen::Vector3d::Constant(squares.sum()) - squares) / 12.0;
      break;
    }
    case ShapeType::kCylinder: {
      const double square = shape.radius_m * shape.radius_m;
      solid.volume_m3 = std::numbers::pi * square * shape.length_m;
      const double lateral = square / 4.0 + shape.length_m * shape.length_m / 12.0;
      moments = {lateral, lateral, square / 2.0};
      break;
    }
    case ShapeType::kSphere: {
      const double square = shape.radius_m * shape.radius_m;
      solid.volume_m3 = 4.0 / 3.0 * std::numbers::pi * square * shape.radius_m;
      moments.setConstant(0.4 * square);
      break;
    }
    case ShapeType::kMesh: {
      const Mesh mesh = welded(whole_mesh(shape));
      solid = integrate(is_closed(mesh) ? mesh : convex_hull(mesh.vertices_m, 256));
      if (solid.volume_m3 <= 0.0) solid = integrate(convex_hull(mesh.vertices_m, 256));
      return solid;
    }
  }
  solid.inertia = (solid.volume_m3 * moments).asDiagonal();
  return solid;
}

}  // namespace

Mesh whole_mesh(const Shape& shape) {
  std::vector<Mesh> parts;
  if (shape.mesh) {
    for (const MeshPart& part : *shape.mesh) parts.push_back(part.mesh);
  }
  return join(parts);
}

std::vector<Eigen::Vector3d> outline(const Shape& shape) {
  std::vector<Eigen::Vector3d> points;
  switch (shape.type) {
    case ShapeType::kBox:
      for (const double x : {-0.5, 0.5}) {
        for (const double y : {-0.5, 0.5}) {
          for (const double z : {-0.5, 0.5})
            points.push_back(shape.T_link_shape * shape.size_m.cwiseProduct(Eigen::Vector3d(x, y, z)).eval());
        }
      }
      break;
    case ShapeType::kCylinder:
      for (const double end : {-0.5, 0.5}) add_ring(shape, end * shape.length_m, points);
      break;
    case ShapeType::kSphere:
      add_sphere(shape, points);
      break;
    case ShapeType::kMesh:
      for (const MeshPart& part : *shape.mesh) {
        for (const Eigen::Vector3d& vertex : part.mesh.vertices_m) points.push_back(shape.T_link_shape * vertex);
      }
      break;
  }
  return points;
}

SolidProperties solid_of(const Shape& shape) {
  SolidProperties solid = local_solid(shape);
  const Eigen::Matrix3d R = shape.T_link_shape.rotation.toRotationMatrix();
  solid.center_m = shape.T_link_shape * solid.center_m;
  solid.inertia = R * solid.inertia * R.transpose();
  return solid;
}

}  // namespace patrol::importer
