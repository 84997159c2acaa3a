#include "importer/site/points/thin_objects.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "core/geometry/convex_polygon.h"

namespace patrol::importer {
namespace {

/// Outline of surfaces in a cell of a layer.
struct OutlineCell {
  struct Point {
    Eigen::Vector3d p_m;
    std::size_t patch;
  };
  std::vector<Point> points;
  float reflectivity = 0.0f;
  bool is_visited = false;
};

using OutlineLayer = std::map<std::array<int, 2>, OutlineCell>;

/// Removes corners of the hull that are closer than a centimeter to the line between their neighbors.
std::vector<Eigen::Vector2d> simplified(const std::vector<Eigen::Vector2d>& hull) {
  constexpr double kFlat_m = 0.01;
  std::vector<Eigen::Vector2d> corners;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Eigen::Vector2d& before = corners.empty() ? hull.back() : corners.back();
    const Eigen::Vector2d along = hull[(i + 1) % hull.size()] - before, off = hull[i] - before;
    const double distance =
        along.norm() > 1e-9 ? std::abs(along.x() * off.y() - along.y() * off.x()) / along.norm() : off.norm();
    if (distance > kFlat_m) corners.push_back(hull[i]);
  }
  return corners;
}

void add_sides(const std::vector<Eigen::Vector2d>& outline, float reflectivity, double low_m, double high_m,
               const ThinObjectSettings& settings, std::vector<Patch>& sides) {
  constexpr double kMinArea_m2 = 4e-4;
  std::vector<Eigen::Vector2d> hull = simplified(convex_hull(outline));
  if (hull.size() < 3 || polygon_area(hull) < kMinArea_m2) return;
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& corner : hull) center += corner / static_cast<double>(hull.size());
  for (Eigen::Vector2d& corner : hull) {
    const Eigen::Vector2d inward = center - corner;
    corner += std::min(1.0, settings.inset_m / std::max(1e-6, inward.norm())) * inward;
  }
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Eigen::Vector2d &a = hull[i], &b = hull[(i + 1) % hull.size()];
    Patch side{.corners_m = {}, .num_corners = 4, .reflectivity = reflectivity, .is_filled_in = true};
    side.corners_m[0] = Eigen::Vector3d(a.x(), a.y(), low_m).cast<float>();
    side.corners_m[1] = Eigen::Vector3d(b.x(), b.y(), low_m).cast<float>();
    side.corners_m[2] = Eigen::Vector3d(b.x(), b.y(), high_m).cast<float>();
    side.corners_m[3] = Eigen::Vector3d(a.x(), a.y(), high_m).cast<float>();
    sides.push_back(side);
  }
}

/// Adds the sides of the thin objects of a layer.
void close_layer(OutlineLayer& layer, const std::vector<Patch>& patches, const ThinObjectSettings& settings,
                 std::vector<Patch>& sides) {
  const int max_cells = static_cast<int>(std::ceil(settings.max_extent_m / settings.cell_m));
  for (auto& [first, cell] : layer) {
    if (cell.is_visited) continue;
    std::vector<std::array<int, 2>> object = {first};
    cell.is_visited = true;
    std::array<int, 2> low = first, high = first;
    for (std::size_t i = 0; i < object.size(); ++i) {
      const std::array<int, 2> at = object[i];
      for (std::size_t axis = 0; axis < 2; ++axis) {
        low[axis] = std::min(low[axis], at[axis]);
        high[axis] = std::max(high[axis], at[axis]);
      }
      for (int k = 0; k < 9; ++k) {
        const auto next = layer.find({at[0] + k % 3 - 1, at[1] + k / 3 - 1});
        if (next == layer.end() || next->second.is_visited) continue;
        next->second.is_visited = true;
        object.push_back(next->first);
      }
    }
    if (high[0] - low[0] >= max_cells || high[1] - low[1] >= max_cells) continue;
    float closest_m = 1e9f, light = 0.0f;
    for (const std::array<int, 2>& at : object) {
      const OutlineCell& part = layer.at(at);
      for (const OutlineCell::Point& point : part.points)
        closest_m = std::min(closest_m, patches[point.patch].spacing_m);
      light += part.reflectivity;
    }
    std::vector<Eigen::Vector2d> outline;
    double low_m = 1e9, high_m = -1e9;
    for (const std::array<int, 2>& at : object) {
      for (const OutlineCell::Point& point : layer.at(at).points) {
        if (patches[point.patch].spacing_m > settings.max_spacing_ratio * closest_m) continue;
        outline.emplace_back(point.p_m.head<2>());
        low_m = std::min(low_m, point.p_m.z());
        high_m = std::max(high_m, point.p_m.z());
      }
    }
    add_sides(outline, light / static_cast<float>(object.size()), low_m, high_m, settings, sides);
  }
}

}  // namespace

std::vector<Patch> close_thin_objects(const std::vector<Patch>& patches, const ScannedGround& ground,
                                      const ThinObjectSettings& settings) {
  constexpr double kSteep = 0.7;
  std::map<int, OutlineLayer> layers;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const Patch& patch = patches[i];
    const Eigen::Vector3d normal = patch.area_normal();
    if (patch.is_filled_in || std::abs(normal.z()) > kSteep * normal.norm()) continue;
    for (const Eigen::Vector3d& p : sample(patch, 0.6 * settings.cell_m)) {
      const double above_m = p.z() - ground.height_at(p.head<2>());
      if (above_m < settings.lowest_m || above_m > settings.highest_m) continue;
      const int layer = static_cast<int>(std::floor(p.z() / settings.layer_m));
      OutlineCell& cell = layers[layer][{static_cast<int>(std::floor(p.x() / settings.cell_m)),
                                         static_cast<int>(std::floor(p.y() / settings.cell_m))}];
      cell.points.push_back({p, i});
      cell.reflectivity = patch.reflectivity;
    }
  }
  std::vector<Patch> sides;
  for (auto& [index, layer] : layers) close_layer(layer, patches, settings, sides);
  return sides;
}

}  // namespace patrol::importer
