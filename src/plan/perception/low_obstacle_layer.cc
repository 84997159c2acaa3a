#include "plan/perception/low_obstacle_layer.h"

#include <algorithm>
#include <utility>

#include "core/point_transform.h"

namespace patrol::plan {
namespace {

constexpr int kMoving_cells = 3;             ///< a low obstacle this near to one of the scan may be a pedestrian's foot
constexpr int kExplainedDistance_cells = 2;  ///< an echo this near to an obstacle of the scan or the map comes from it

}  // namespace

void LowObstacleLayer::resize(const CellLattice& lattice) {
  lattice_ = lattice;
  is_low_ = Grid<std::uint8_t>(lattice.geometry, 0);
  for (const Cell cell : low_.obstacles()) is_low_.at(lattice.to_grid(cell)) = 1;
}

std::vector<Cell> LowObstacleLayer::lattice_cells(const std::vector<Eigen::Vector2d>& p_level, const Pose2& T_map_body,
                                                  int min_count) const {
  std::vector<Cell> hit;
  hit.reserve(p_level.size());
  const PointTransform to_map(T_map_body);
  for (const Eigen::Vector2d& p : p_level) {
    const Cell cell = lattice_.geometry.cell_at(to_map(p));
    if (lattice_.geometry.contains(cell)) hit.push_back(lattice_.to_lattice(cell));
  }
  // Sorted, so that the order of the cells does not depend on that of the points.
  std::ranges::sort(hit, {}, [](Cell cell) { return std::pair(cell.row, cell.col); });
  std::vector<Cell> cells;
  for (auto first = hit.begin(); first != hit.end();) {
    const auto end = std::find_if(first, hit.end(), [&](Cell cell) { return cell != *first; });
    if (end - first >= min_count) cells.push_back(*first);
    first = end;
  }
  return cells;
}

CellBoxes LowObstacleLayer::add_image(const DepthPoints& points, Time stamp, const Pose2& T_map_body,
                                      const ScanLayer& scan) {
  const std::vector<Cell> obstacles = lattice_cells(points.obstacles_m, T_map_body, settings_.min_camera_points);
  std::vector<bool> may_move;
  for (const Cell cell : obstacles) may_move.push_back(scan.has_obstacle_near(lattice_.to_grid(cell), kMoving_cells));
  // Cells with obstacle points of the same image are not ground.
  std::vector<Cell> ground;
  const std::vector<Cell> obstacle_cells = lattice_cells(points.obstacles_m, T_map_body, 1);
  for (const Cell cell : lattice_cells(points.ground_m, T_map_body, settings_.min_camera_points)) {
    if (std::find(obstacle_cells.begin(), obstacle_cells.end(), cell) == obstacle_cells.end()) ground.push_back(cell);
  }
  low_.add_image(obstacles, ground, may_move, stamp);
  low_.clear_expired(stamp);
  return apply_changes();
}

CellBoxes LowObstacleLayer::add_ping(const SonarCone& cone, Time stamp, const Pose2& T_map_body, const ScanLayer& scan,
                                     const StaticMapLayer& map) {
  std::vector<Cell> arc = lattice_cells(cone.arc_m, T_map_body, 1);
  const auto is_explained = [&](Cell lattice) {
    const Cell cell = lattice_.to_grid(lattice);
    return scan.has_obstacle_near(cell, kExplainedDistance_cells) ||
           map.has_obstacle_near(cell, kExplainedDistance_cells);
  };
  if (std::any_of(arc.begin(), arc.end(), is_explained)) arc.clear();
  low_.add_ping(arc, lattice_cells(cone.free_m, T_map_body, 1), stamp);
  low_.clear_expired(stamp);
  return apply_changes();
}

CellBoxes LowObstacleLayer::clear_sonar(const Eigen::Vector2d& p_map, double radius_m) {
  low_.clear_sonar_evidence([&](Cell lattice) {
    return (lattice_.geometry.center_of(lattice_.to_grid(lattice)) - p_map).norm() <= radius_m;
  });
  return apply_changes();
}

void LowObstacleLayer::mark_obstacles(Cell first, int count, std::uint8_t* is_obstacle) const {
  const std::uint8_t* is_low = &is_low_.at(first);
  for (int i = 0; i < count; ++i) is_obstacle[i] |= is_low[i];
}

CellBoxes LowObstacleLayer::apply_changes() {
  CellBoxes changed;
  for (const Cell lattice : low_.take_changed()) {
    const Cell cell = lattice_.to_grid(lattice);
    is_low_.at(cell) = low_.is_obstacle(lattice) ? 1 : 0;
    changed.extend(cell);
  }
  return changed;
}

}  // namespace patrol::plan
