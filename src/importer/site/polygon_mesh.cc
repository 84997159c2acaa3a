#include "importer/site/polygon_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

namespace patrol::importer {
namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const Eigen::Vector2d u = b - a, v = c - a;
  return u.x() * v.y() - u.y() * v.x();
}

/// Returns the triangles of a counterclockwise polygon; empty if it is not simple.
std::vector<std::array<int, 3>> clip_ears(const std::vector<Eigen::Vector2d>& corners) {
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> open(corners.size());
  std::iota(open.begin(), open.end(), 0);
  const auto at = [&](int i) -> const Eigen::Vector2d& { return corners[static_cast<std::size_t>(i)]; };
  while (open.size() >= 3) {
    bool is_clipped = false;
    for (std::size_t i = 0; i < open.size() && !is_clipped; ++i) {
      const int a = open[(i + open.size() - 1) % open.size()], b = open[i], c = open[(i + 1) % open.size()];
      const double area = cross(at(a), at(b), at(c));
      if (area < 0.0) continue;
      const bool is_ear = area == 0.0 || std::none_of(open.begin(), open.end(), [&](int k) {
                            return k != a && k != b && k != c && cross(at(a), at(b), at(k)) >= 0.0 &&
                                   cross(at(b), at(c), at(k)) >= 0.0 && cross(at(c), at(a), at(k)) >= 0.0;
                          });
      if (!is_ear) continue;
      if (area > 0.0) triangles.push_back({a, b, c});
      open.erase(open.begin() + static_cast<std::ptrdiff_t>(i));
      is_clipped = true;
    }
    if (!is_clipped) return {};
  }
  return triangles;
}

}  // namespace

Mesh extruded_polygon(std::vector<Eigen::Vector2d> corners_m, double height_m) {
  if (corners_m.size() > 1 && (corners_m.front() - corners_m.back()).norm() < 1e-9) corners_m.pop_back();
  if (corners_m.size() < 3) return {};
  double twice_area = 0.0;
  for (std::size_t i = 0; i < corners_m.size(); ++i)
    twice_area += cross(corners_m[0], corners_m[i], corners_m[(i + 1) % corners_m.size()]);
  if (twice_area < 0.0) std::reverse(corners_m.begin(), corners_m.end());
  const std::vector<std::array<int, 3>> faces = clip_ears(corners_m);
  if (faces.empty()) return {};
  Mesh mesh;
  const int count = static_cast<int>(corners_m.size());
  for (const double z : {0.0, height_m}) {
    for (const Eigen::Vector2d& corner : corners_m) mesh.vertices_m.emplace_back(corner.x(), corner.y(), z);
  }
  for (const std::array<int, 3>& face : faces) {
    mesh.triangles.push_back({face[2], face[1], face[0]});
    mesh.triangles.push_back({count + face[0], count + face[1], count + face[2]});
  }
  for (int i = 0; i < count; ++i) {
    const int next = (i + 1) % count;
    mesh.triangles.push_back({i, next, count + next});
    mesh.triangles.push_back({i, count + next, count + i});
  }
  return mesh;
}

Mesh cone(double radius_m, double length_m) {
  constexpr int kSides = 32;
  Mesh mesh;
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kSides;
    mesh.vertices_m.emplace_back(radius_m * std::cos(angle), radius_m * std::sin(angle), -0.5 * length_m);
  }
  mesh.vertices_m.emplace_back(0.0, 0.0, -0.5 * length_m);
  mesh.vertices_m.emplace_back(0.0, 0.0, 0.5 * length_m);
  for (int i = 0; i < kSides; ++i) {
    const int next = (i + 1) % kSides;
    mesh.triangles.push_back({next, i, kSides});
    mesh.triangles.push_back({i, next, kSides + 1});
  }
  return mesh;
}

}  // namespace patrol::importer
