#include "plan/perception/scan_layer.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/point_transform.h"

namespace patrol::plan {
namespace {

/// Observed range of a scan by direction around the lidar: the minimum range of the beams in each sector.
class ObservedRange {
 public:
  explicit ObservedRange(const LevelScan& scan)
      : sectors_(std::clamp<std::size_t>(scan.beams.size() / 2, 1, 720), 0.0f),
        sectors_per_rad_(static_cast<double>(sectors_.size()) / (2.0 * std::numbers::pi)) {
    for (const LevelScan::Beam& beam : scan.beams) {
      const Eigen::Vector2d along = beam.end_m.cast<double>() - scan.origin_m;
      float& range = sectors_[sector(along)];
      const auto length = static_cast<float>(along.norm());
      range = range > 0.0f ? std::min(range, length) : length;
    }
  }
  /// Observed range in a direction; 0 in sectors without a beam.
  double along(const Eigen::Vector2d& direction) const { return sectors_[sector(direction)]; }

 private:
  std::size_t sector(const Eigen::Vector2d& direction) const {
    const double angle = std::atan2(direction.y(), direction.x()) + std::numbers::pi;
    return std::min(static_cast<std::size_t>(angle * sectors_per_rad_), sectors_.size() - 1);
  }

  std::vector<float> sectors_;
  double sectors_per_rad_;
};

}  // namespace

void ScanLayer::resize(const CellLattice& lattice) {
  lattice_ = lattice;
  index_ = Grid<std::uint32_t>(lattice.geometry, 0);
  for (std::size_t i = 0; i < obstacles_.size(); ++i)
    index_.at(to_cell(obstacles_[i])) = static_cast<std::uint32_t>(i + 1);
}

CellBoxes ScanLayer::add_scan(const LevelScan& scan, const Pose2& T_map_body, const StaticMapLayer& map) {
  CellBoxes changed;
  clear_passed(scan, T_map_body, map, changed);
  mark_hits(scan, T_map_body, map, changed);
  return changed;
}

void ScanLayer::clear_passed(const LevelScan& scan, const Pose2& T_map_body, const StaticMapLayer& map,
                             CellBoxes& changed) {
  const ObservedRange seen(scan);
  const PointTransform to_body(T_map_body.inverse());
  const Time memory = from_seconds(settings_.obstacle_persistence_s);
  const double slack_m = 0.75 * settings_.resolution_m;
  for (std::size_t i = 0; i < obstacles_.size();) {
    const Cell cell = to_cell(obstacles_[i]);
    const Eigen::Vector2d from_lidar = to_body(lattice_.geometry.center_of(cell)) - scan.origin_m;
    const bool is_passed = seen.along(from_lidar) > from_lidar.norm() + slack_m;
    const bool is_old = scan.stamp - obstacles_[i].seen > memory;
    if (!is_passed && !is_old && !map.has_obstacle_near(cell, settings_.map_match_tolerance_cells)) {
      ++i;
      continue;
    }
    changed.extend(cell);
    index_.at(cell) = 0;
    obstacles_[i] = obstacles_.back();
    obstacles_.pop_back();
    if (i < obstacles_.size()) index_.at(to_cell(obstacles_[i])) = static_cast<std::uint32_t>(i + 1);
  }
}

void ScanLayer::mark_hits(const LevelScan& scan, const Pose2& T_map_body, const StaticMapLayer& map,
                          CellBoxes& changed) {
  const PointTransform to_map(T_map_body);
  for (const LevelScan::Beam& beam : scan.beams) {
    const Eigen::Vector2d end_m = beam.end_m.cast<double>();
    if (!beam.is_hit || (end_m - scan.origin_m).norm() > settings_.obstacle_range_m) continue;
    const Cell cell = lattice_.geometry.cell_at(to_map(end_m));
    if (!index_.contains(cell) || map.has_obstacle_near(cell, settings_.map_match_tolerance_cells)) continue;
    if (index_.at(cell) != 0) {
      obstacles_[index_.at(cell) - 1].seen = scan.stamp;
      continue;
    }
    obstacles_.push_back({.lattice = lattice_.to_lattice(cell), .seen = scan.stamp, .first_seen = scan.stamp});
    index_.at(cell) = static_cast<std::uint32_t>(obstacles_.size());
    changed.extend(cell);
  }
}

CellBoxes ScanLayer::clear(const Eigen::Vector2d& p_map, double radius_m) {
  CellBoxes changed;
  std::vector<Obstacle> kept;
  for (const Obstacle& obstacle : obstacles_) {
    const Cell cell = to_cell(obstacle);
    index_.at(cell) = 0;
    if ((lattice_.geometry.center_of(cell) - p_map).norm() > radius_m) {
      kept.push_back(obstacle);
      index_.at(cell) = static_cast<std::uint32_t>(kept.size());
    } else {
      changed.extend(cell);
    }
  }
  obstacles_ = std::move(kept);
  return changed;
}

void ScanLayer::mark_obstacles(Cell first, int count, std::uint8_t* is_obstacle) const {
  const std::uint32_t* index = &index_.at(first);
  for (int i = 0; i < count; ++i) is_obstacle[i] |= index[i] != 0 ? 1 : 0;
}

bool ScanLayer::has_obstacle_near(Cell cell, int radius_cells) const {
  return any_cell_near(cell, radius_cells, [this](Cell near) { return contains_obstacle(near); });
}

std::optional<Time> ScanLayer::first_seen(const Eigen::Vector2d& p_map, double radius_m) const {
  const int radius_cells = static_cast<int>(std::ceil(radius_m / settings_.resolution_m));
  const Cell center = lattice_.geometry.cell_at(p_map);
  std::optional<Time> first;
  for (int row = center.row - radius_cells; row <= center.row + radius_cells; ++row) {
    for (int col = center.col - radius_cells; col <= center.col + radius_cells; ++col) {
      const Cell cell{col, row};
      if (!contains_obstacle(cell) || (lattice_.geometry.center_of(cell) - p_map).norm() > radius_m) continue;
      const Time seen = obstacles_[index_.at(cell) - 1].first_seen;
      first = first ? std::min(*first, seen) : seen;
    }
  }
  return first;
}

}  // namespace patrol::plan
