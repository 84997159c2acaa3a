#pragma once

#include <optional>
#include <vector>

#include "inspect/lining/lining_grid.h"
#include "inspect/lining/lining_settings.h"
#include "inspect/lining/surface_cloud.h"

namespace patrol::inspect {

/// Surface of the lining in the reference scan, unrolled: inward offset from the design as a function of chainage and
/// clock position. Each ring is a separate surface; there is no interpolation across ring joints.
class ReferenceLining {
 public:
  ReferenceLining(const LiningInMap& lining, const LiningGrid& grid, const std::vector<DownsampledPoint>& points_map,
                  const LiningSettings& settings);

  /// Returns the inward offset at a point, from a plane fitted to the points around it. The slope has a prior near the
  /// design. Returns nullopt if there are too few points.
  std::optional<double> inward_m(const LiningPoint& point, int cell) const;

  int points(int cell) const { return static_cast<int>(cells_[static_cast<std::size_t>(cell)].points.size()); }
  /// Returns the variance of the mean of a cell, from the scatter around the planes.
  double var_m2(int cell) const { return cells_[static_cast<std::size_t>(cell)].var_m2; }

 private:
  struct Point {
    double chainage_m, arc_m, inward_m;
  };
  struct Cell {
    std::vector<Point> points;
    double radius_m = 0.0;  ///< neighborhood radius of a point
    double var_m2 = 0.0;
  };
  /// Returns the inward offset at a point of the unrolled cell. `without`: point to exclude, or null.
  std::optional<double> inward_m(double chainage_m, double arc_m, int cell, const Point* without) const;

  LiningGrid grid_;
  double arc_per_deg_m_ = 0.0;
  std::vector<Cell> cells_;
};

}  // namespace patrol::inspect
