#include "plan/perception/keep_out_layer.h"

#include <algorithm>
#include <utility>

#include "core/geometry/segment.h"
#include "plan/perception/cell_box.h"

namespace patrol::plan {

KeepOutLayer::KeepOutLayer(const CostmapSettings& settings, std::vector<Polyline> lines_in_map, double max_distance_m)
    : margin_m_(settings.keep_out_margin_m),
      inflation_m_(settings.keep_out_inflation_m),
      cutoff_m_(settings.keep_out_margin_m + std::max(settings.keep_out_inflation_m, max_distance_m)),
      lines_(std::move(lines_in_map)) {}

void KeepOutLayer::resize(const CellLattice& lattice) {
  distance_m_ = Grid<float>(lattice.geometry, static_cast<float>(cutoff_m_));
  for (const Polyline& line : lines_) {
    for (std::size_t i = 0; i + 1 < line.size(); ++i) rasterize(line[i], line[i + 1]);
  }
  cost_ = Grid<Cost>(lattice.geometry, kFreeCost);
  if (lines_.empty()) return;
  std::transform(distance_m_.values().begin(), distance_m_.values().end(), cost_.values().begin(),
                 [this](float distance_m) { return cost_of(distance_m); });
}

Cost KeepOutLayer::cost_of(float distance_m) const {
  const auto margin_m = static_cast<float>(margin_m_), end_m = static_cast<float>(margin_m_ + inflation_m_);
  if (distance_m >= end_m) return kFreeCost;
  return distance_m <= margin_m ? kLethalCost : decaying_cost(distance_m - margin_m, inflation_m_ / 3.0);
}

void KeepOutLayer::rasterize(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const GridGeometry& geometry = distance_m_.geometry();
  CellBox box;
  box.extend(geometry.cell_at(a.cwiseMin(b).array() - cutoff_m_));
  box.extend(geometry.cell_at(a.cwiseMax(b).array() + cutoff_m_));
  box = box.grown(0, geometry);
  for (int row = box.min.row; row <= box.max.row; ++row) {
    for (int col = box.min.col; col <= box.max.col; ++col) {
      float& nearest = distance_m_.at({col, row});
      nearest = std::min(nearest, static_cast<float>(distance_to_segment(geometry.center_of({col, row}), a, b)));
    }
  }
}

double KeepOutLayer::distance_m(const Eigen::Vector2d& p_map) const {
  return distance_m(BilinearCell(distance_m_.geometry(), p_map));
}

double KeepOutLayer::distance_m(const BilinearCell& at) const {
  const float* const distance_m = distance_m_.values().data();
  return at.interpolate([&](std::size_t cell) { return static_cast<double>(distance_m[cell]); });
}

void KeepOutLayer::raise_costs(Cell first, int count, Cost* cost) const {
  if (lines_.empty()) return;
  const Cost* line_cost = &cost_.at(first);
  for (int i = 0; i < count; ++i) cost[i] = std::max(cost[i], line_cost[i]);
}

}  // namespace patrol::plan
