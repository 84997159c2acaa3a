#include "score/distance_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/distance_transform.h"

namespace patrol::score {
namespace {

constexpr std::int8_t kOccupiedPercent = 65;

}  // namespace

DistanceField::DistanceField(const Grid<std::uint8_t>& occupied)
    : geometry_(occupied.geometry()),
      distance_m_(squared_distances_float(occupied.values(), geometry_.width, geometry_.height)),
      is_empty_(
          std::all_of(occupied.values().begin(), occupied.values().end(), [](auto value) { return value == 0; })) {
  const auto resolution_m = static_cast<float>(geometry_.resolution_m);
  for (float& distance : distance_m_) distance = resolution_m * std::sqrt(distance);
}

DistanceField::GridPosition DistanceField::grid_position(const Eigen::Vector2d& p_m) const {
  const Eigen::Vector2d last(geometry_.width - 1, geometry_.height - 1);
  const Eigen::Vector2d q = (p_m - geometry_.origin_m) / geometry_.resolution_m - Eigen::Vector2d(0.5, 0.5);
  const Eigen::Vector2d inside = q.cwiseMax(0.0).cwiseMin(last);
  const auto col =
      std::min(static_cast<std::size_t>(inside.x()), static_cast<std::size_t>(std::max(0, geometry_.width - 2)));
  const auto row =
      std::min(static_cast<std::size_t>(inside.y()), static_cast<std::size_t>(std::max(0, geometry_.height - 2)));
  const auto width = static_cast<std::size_t>(geometry_.width);
  const std::size_t right = geometry_.width > 1 ? 1 : 0, up = geometry_.height > 1 ? width : 0;
  const std::size_t at = row * width + col;
  return {.corners = {distance_m_[at], distance_m_[at + right], distance_m_[at + up], distance_m_[at + up + right]},
          .fraction = inside - Eigen::Vector2d(static_cast<double>(col), static_cast<double>(row)),
          .offset_to_grid = q - inside};
}

double DistanceField::distance_m(const Eigen::Vector2d& p_m) const {
  if (is_empty_) return std::numeric_limits<double>::infinity();
  const auto [corners, f, offset_to_grid] = grid_position(p_m);
  const double low = (1.0 - f.x()) * corners[0] + f.x() * corners[1];
  const double high = (1.0 - f.x()) * corners[2] + f.x() * corners[3];
  return (1.0 - f.y()) * low + f.y() * high + geometry_.resolution_m * offset_to_grid.norm();
}

// Derivative of the bilinear piece itself: a finite difference would be too small within one step of an occupied cell,
// where the distance has a kink.
Eigen::Vector2d DistanceField::gradient(const Eigen::Vector2d& p_m) const {
  if (is_empty_) return Eigen::Vector2d::Zero();
  const auto [corners, f, offset_to_grid] = grid_position(p_m);
  const Eigen::Vector2d rise((1.0 - f.y()) * (corners[1] - corners[0]) + f.y() * (corners[3] - corners[2]),
                             (1.0 - f.x()) * (corners[2] - corners[0]) + f.x() * (corners[3] - corners[1]));
  const Eigen::Vector2d is_inside = (offset_to_grid.array() == 0.0).cast<double>();
  return rise.cwiseProduct(is_inside) / geometry_.resolution_m + offset_to_grid.stableNormalized();
}

Grid<std::uint8_t> occupied_cells(const OccupancyGrid& map) {
  Grid<std::uint8_t> occupied(map.geometry());
  std::transform(map.values().begin(), map.values().end(), occupied.values().begin(),
                 [](std::int8_t percent) { return static_cast<std::uint8_t>(percent >= kOccupiedPercent); });
  return occupied;
}

}  // namespace patrol::score
