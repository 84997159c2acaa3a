#include "localize/amcl/distance_to_occupied.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/geometry/distance_transform.h"
#include "core/map_cells.h"

namespace patrol::localize {

Grid<float> distance_to_occupied(const OccupancyGrid& map, double cap_m) {
  const GridGeometry& geometry = map.geometry();
  std::vector<std::uint8_t> is_obstacle(geometry.size());
  std::transform(map.values().begin(), map.values().end(), is_obstacle.begin(),
                 [](std::int8_t percent) { return static_cast<std::uint8_t>(is_occupied(percent)); });
  const double cap_cells = cap_m / geometry.resolution_m;
  const auto squared_cap = static_cast<float>(cap_cells * cap_cells),
             resolution_m = static_cast<float>(geometry.resolution_m);
  const auto to_distance = [=](auto squared) {
    return resolution_m * std::sqrt(std::min(squared_cap, static_cast<float>(squared)));
  };

  Grid<float> distance_m(geometry);
  if (cap_cells < DistanceTransform::kMaxCap_cells) {
    DistanceTransform::SquaredDistances squared;
    DistanceTransform(static_cast<int>(cap_cells) + 1).compute(is_obstacle, geometry.width, geometry.height, squared);
    std::transform(squared.begin(), squared.end(), distance_m.values().begin(), to_distance);
  } else {
    const std::vector<double> squared = squared_distances(is_obstacle, geometry.width, geometry.height);
    std::transform(squared.begin(), squared.end(), distance_m.values().begin(), to_distance);
  }
  return distance_m;
}

}  // namespace patrol::localize
