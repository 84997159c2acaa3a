#pragma once

#include <optional>
#include <vector>

#include "inspect/lining/lining_grid.h"
#include "inspect/lining/lining_settings.h"
#include "inspect/lining/surface_cloud.h"

namespace patrol::inspect {

/// The lining as the reference scan shows it, unrolled: how far it lies inside the design, as a function of chainage and clock. Each ring
/// is one surface; across a joint nothing is interpolated.
class ReferenceLining {
 public:
  ReferenceLining(const LiningInMap& lining, const LiningGrid& grid, const std::vector<ThinPoint>& points_map, const LiningSettings& settings);

  /// By a plane through the points about it, whose slope is held near the design's; none where there are too few.
  std::optional<double> inward_m(const LiningPoint& point, int cell) const;

  int points(int cell) const { return static_cast<int>(cells_[static_cast<std::size_t>(cell)].points.size()); }
  /// Of a cell's mean, by the scatter about the planes.
  double var_m2(int cell) const { return cells_[static_cast<std::size_t>(cell)].var_m2; }

 private:
  struct Point {
    double chainage_m, arc_m, inward_m;
  };
  struct Cell {
    std::vector<Point> points;
    double radius_m = 0.0;  ///< of the neighbourhood of a point
    double var_m2 = 0.0;
  };
  /// `without`: a point that does not count, or null.
  std::optional<double> inward_m(double chainage_m, double arc_m, int cell, const Point* without) const;

  LiningGrid grid_;
  double arc_per_deg_m_ = 0.0;
  std::vector<Cell> cells_;
};

}  // namespace patrol::inspect
