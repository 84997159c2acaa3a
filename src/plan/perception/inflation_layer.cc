#include "plan/perception/inflation_layer.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "plan/perception/bilinear.h"

namespace patrol::plan {
namespace {

/// Cap of the distance transform, cells: covers all distances with a cost, and all clearances of the robot's outline.
int cap_of(const CostmapSettings& settings, const Footprint& footprint) {
  const double range_m = std::max(settings.inflation_radius_m, footprint.circumscribed_radius_m() + 0.3);
  return std::clamp(static_cast<int>(std::ceil(range_m / settings.resolution_m)) + 1, 2,
                    DistanceTransform::kMaxCap_cells);
}

/// Checks that the lethal distance is within the cap; otherwise cells at a lethal distance would be free.
void check_cap(const CostmapSettings& settings, const Footprint& footprint, double lethal_m) {
  const double range_m = settings.resolution_m * (cap_of(settings, footprint) - 1);
  if (lethal_m <= range_m) return;
  throw InputError(
      fmt::format("outline and margins of {:.2f} m exceed the costmap's range of {:.2f} m: "
                  "costmap.inflation_radius_m or costmap.resolution_m must be larger",
                  lethal_m, range_m));
}

}  // namespace

InflationLayer::InflationLayer(const CostmapSettings& settings, const Footprint& footprint)
    : transform_(cap_of(settings, footprint)) {
  const double lethal_m = footprint.inscribed_radius_m() + settings.safety_margin_m + settings.route_margin_m;
  check_cap(settings, footprint, lethal_m);
  for (int squared = 0; squared <= transform_.beyond(); ++squared) {
    // The surface of an obstacle lies somewhere in its cell; half a cell is the mean.
    const double distance = std::max(0.0, settings.resolution_m * (std::sqrt(squared) - 0.5));
    distance_of_.push_back(distance);
    const bool is_felt = squared < transform_.beyond() && distance <= settings.inflation_radius_m;
    const Cost decayed = is_felt ? decaying_cost(distance - lethal_m, settings.inflation_decay_m) : kFreeCost;
    cost_of_.push_back(squared < transform_.beyond() && distance <= lethal_m ? kLethalCost : decayed);
  }
}

void InflationLayer::resize(const CellLattice& lattice) {
  squared_ = Grid<std::int16_t>(lattice.geometry, transform_.beyond());
}

void InflationLayer::update_distances(const CellBox& window, const CellBox& target) {
  transform_.compute(is_obstacle_, window.width(), window.height(),
                     {.col = target.min.col - window.min.col,
                      .row = target.min.row - window.min.row,
                      .width = target.width(),
                      .height = target.height()},
                     target_squared_);
  const std::int16_t* squared = target_squared_.data();
  for (int row = target.min.row; row <= target.max.row; ++row, squared += target.width())
    std::copy(squared, squared + target.width(), &squared_.at({target.min.col, row}));
}

double InflationLayer::distance_m(const Eigen::Vector2d& p_map) const {
  return distance_m(BilinearCell(squared_.geometry(), p_map));
}

double InflationLayer::distance_m(const BilinearCell& at) const {
  const std::int16_t* const squared = squared_.values().data();
  const double* const distance_of = distance_of_.data();
  return at.interpolate([&](std::size_t cell) { return distance_of[squared[cell]]; });
}

void InflationLayer::set_costs(Cell first, int count, Cost* cost) const {
  const std::int16_t* squared = &squared_.at(first);
  for (int i = 0; i < count; ++i) cost[i] = cost_of_[static_cast<std::size_t>(squared[i])];
}

}  // namespace patrol::plan
