#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/grid.h"
#include "core/route.h"

namespace patrol::importer {

/// Part of a floor plan in which a robot can stand: the free cells, and their distance to the nearest cell that is
/// occupied or unknown.
class FreeSpace {
 public:
  /// Free cells with at least `min_clearance_m` that are connected to each other: the region that contains the cell
  /// nearest to `p_start_m`, or the one of `choose_region` with at least kMinEnclosed_m2. `margin_m`: width of the
  /// margin along the border of the plan that does not count as area. Throws InputError if there is none.
  FreeSpace(const OccupancyGrid& plan, double min_clearance_m, const std::optional<Eigen::Vector2d>& p_start_m,
            double margin_m = 0.0);

  /// Whether the region is inside of walls, although one with its margin is larger.
  bool is_enclosed() const { return is_enclosed_; }

  bool contains(const Eigen::Vector2d& p_m) const;
  /// Returns the center of the nearest cell of the region.
  Eigen::Vector2d nearest(const Eigen::Vector2d& p_m) const;
  /// Centers of the cells of the region, row by row.
  const std::vector<Eigen::Vector2d>& cells_m() const { return cells_m_; }

 private:
  GridGeometry grid_;
  Grid<std::uint8_t> region_;  ///< 1 in the region
  std::vector<Eigen::Vector2d> cells_m_;
  bool is_enclosed_ = false;
};

/// Returns the area of the free cells with at least `min_clearance_m` to cells that are occupied or unknown, m2.
double area_with_clearance_m2(const OccupancyGrid& plan, double min_clearance_m);

/// Returns why a robot cannot stand at a position of a floor plan, such as "outside the floor plan"; none if it can.
/// `min_clearance_m`: minimum distance to cells that are occupied or unknown.
std::optional<std::string> clearance_problem(const OccupancyGrid& plan, double min_clearance_m,
                                             const Eigen::Vector2d& p_m);

/// Returns `count` stations at random cells of a region, at least `separation_m` apart while there is room, half of it
/// when 100 draws found none, and so on. Each faces away from the one before; the first one from the start. A last
/// station, "home", is the start.
std::vector<Station> random_stations(const FreeSpace& space, const Pose2& start, int count, std::uint64_t seed,
                                     double separation_m = 3.0);

/// Returns stations along a path, one every `spacing_m` of its length, without those outside the region. The last one
/// is of type home. Throws InputError if none is inside.
std::vector<Station> stations_along(const std::vector<Pose2>& path, const FreeSpace& space, double spacing_m);

}  // namespace patrol::importer
