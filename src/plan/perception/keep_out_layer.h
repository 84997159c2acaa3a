#pragma once

#include <utility>
#include <vector>

#include "plan/perception/bilinear.h"
#include "plan/perception/cell_lattice.h"
#include "plan/perception/cost.h"
#include "plan/perception/costmap_settings.h"

namespace patrol::plan {

using Polyline = std::vector<Eigen::Vector2d>;

/// Costmap layer of surveyed lines that the lidar cannot see (full-height curbs): lethal within a margin, then falling
/// exponentially.
class KeepOutLayer {
 public:
  /// Distances are exact up to the margin plus `max_distance_m`, at least as far as a line has a cost.
  KeepOutLayer(const CostmapSettings& settings, std::vector<Polyline> lines_in_map, double max_distance_m);

  void resize(const CellLattice& lattice);
  /// Replaces the lines; they have costs from the next `resize` on.
  void set_lines(std::vector<Polyline> lines_in_map) { lines_ = std::move(lines_in_map); }
  const std::vector<Polyline>& lines() const { return lines_; }
  /// Distance to the nearest line, interpolated between cells.
  double distance_m(const Eigen::Vector2d& p_map) const;
  /// Interpolated distance at a position in the layer's lattice.
  double distance_m(const BilinearCell& at) const;
  /// Raises the costs of `count` cells of a row to those of the lines.
  void raise_costs(Cell first, int count, Cost* cost) const;

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(lines_, distance_m_, cost_);
  }

 private:
  void rasterize(const Eigen::Vector2d& a, const Eigen::Vector2d& b);
  Cost cost_of(float distance_m) const;

  double margin_m_, inflation_m_, cutoff_m_;
  std::vector<Polyline> lines_;
  Grid<float> distance_m_;
  Grid<Cost> cost_;
};

}  // namespace patrol::plan
