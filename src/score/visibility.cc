#include "score/visibility.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <future>
#include <limits>
#include <numbers>
#include <optional>

namespace patrol::score {
namespace {

std::vector<Eigen::Vector2d> thin_out(const Trajectory& T_world_body, double spacing_m) {
  std::vector<Eigen::Vector2d> positions;
  for (const StampedPose& entry : T_world_body) {
    const Eigen::Vector2d p = entry.pose.position.head<2>();
    if (positions.empty() || (p - positions.back()).norm() >= spacing_m) positions.push_back(p);
  }
  return positions;
}

void mark_neighborhood(const OccupancyGrid& cells, Grid<std::uint8_t>& marked, Cell hit) {
  for (int row = hit.row - 1; row <= hit.row + 1; ++row) {
    for (int col = hit.col - 1; col <= hit.col + 1; ++col) {
      if (cells.contains({col, row}) && cells.at({col, row}) == kOccupied) marked.at({col, row}) = 1;
    }
  }
}

/// Returns the distance after which a ray from outside is inside of the grid; none if it misses the grid.
std::optional<double> entry_m(const GridGeometry& geometry, const Eigen::Vector2d& from_m,
                              const Eigen::Vector2d& direction) {
  constexpr double kInside_m = 1e-9;
  double enter_m = 0.0, leave_m = std::numeric_limits<double>::infinity();
  const Eigen::Vector2d size_m = geometry.resolution_m * Eigen::Vector2d(geometry.width, geometry.height);
  for (int axis = 0; axis < 2; ++axis) {
    const double low_m = geometry.origin_m[axis] - from_m[axis], high_m = low_m + size_m[axis];
    if (std::abs(direction[axis]) < 1e-12) {
      if (low_m > 0.0 || high_m <= 0.0) return std::nullopt;
      continue;
    }
    const double a = low_m / direction[axis], b = high_m / direction[axis];
    enter_m = std::max(enter_m, std::min(a, b));
    leave_m = std::min(leave_m, std::max(a, b));
  }
  if (enter_m + kInside_m >= leave_m) return std::nullopt;
  return enter_m + kInside_m;
}

/// Marks the cells along a ray in order [Amanatides87], up to the first that is occupied or unknown. A run has 10^9
/// steps: cells are addressed by their index, and the border is found by counting steps.
void mark_ray(const OccupancyGrid& cells, Grid<std::uint8_t>& marked, const Eigen::Vector2d& from_m, double angle_rad,
              double max_range_m) {
  const GridGeometry& geometry = cells.geometry();
  const Eigen::Vector2d direction(std::cos(angle_rad), std::sin(angle_rad));
  const Cell first = geometry.cell_at(from_m);
  if (!geometry.contains(first)) {
    const std::optional<double> outside_m = entry_m(geometry, from_m, direction);
    if (!outside_m || *outside_m > max_range_m) return;
    const Eigen::Vector2d border_m = from_m + *outside_m * direction;
    if (geometry.contains(geometry.cell_at(border_m)))
      mark_ray(cells, marked, border_m, angle_rad, max_range_m - *outside_m);
    return;
  }
  const Eigen::Vector2d q = (from_m - geometry.origin_m) / geometry.resolution_m;
  double next_m[2], stride_m[2];
  for (int axis = 0; axis < 2; ++axis) {
    const double speed = std::abs(direction[axis]);
    const double to_border =
        direction[axis] > 0.0 ? std::floor(q[axis]) + 1.0 - q[axis] : q[axis] - std::floor(q[axis]);
    const bool moves = speed > 1e-12;
    stride_m[axis] = moves ? geometry.resolution_m / speed : std::numeric_limits<double>::infinity();
    next_m[axis] = moves ? to_border * geometry.resolution_m / speed : std::numeric_limits<double>::infinity();
  }
  const std::ptrdiff_t width = geometry.width;
  const std::ptrdiff_t column_step = direction.x() > 0.0 ? 1 : -1, row_step = direction.y() > 0.0 ? width : -width;
  int columns_left = direction.x() > 0.0 ? geometry.width - 1 - first.col : first.col;
  int rows_left = direction.y() > 0.0 ? geometry.height - 1 - first.row : first.row;
  const std::int8_t* values = cells.values().data();
  std::uint8_t* is_observable = marked.values().data();
  std::ptrdiff_t at = first.row * width + first.col;
  while (true) {
    const std::int8_t value = values[at];
    if (value == kUnknown) return;
    is_observable[at] = 1;
    if (value == kOccupied) {
      return mark_neighborhood(cells, marked, {static_cast<int>(at % width), static_cast<int>(at / width)});
    }
    const bool is_column_next = next_m[0] < next_m[1];
    if ((is_column_next ? next_m[0] : next_m[1]) > max_range_m) return;
    if (is_column_next) {
      if (--columns_left < 0) return;
      next_m[0] += stride_m[0];
      at += column_step;
    } else {
      if (--rows_left < 0) return;
      next_m[1] += stride_m[1];
      at += row_step;
    }
  }
}

}  // namespace

ReferenceMap mark_observable(OccupancyGrid reference, const Trajectory& T_world_body, double max_range_m,
                             double spacing_m) {
  const GridGeometry geometry = reference.geometry();
  ReferenceMap marked{std::move(reference), Grid<std::uint8_t>(geometry)};
  // Adjacent rays are two cells apart at full range; `mark_neighborhood` fills the gap.
  const double step_rad = 2.0 * geometry.resolution_m / max_range_m;
  const int num_rays = static_cast<int>(std::ceil(2.0 * std::numbers::pi / step_rad));
  const std::vector<Eigen::Vector2d> positions = thin_out(T_world_body, spacing_m);
  const auto mark_from = [&](std::size_t first, std::size_t step, Grid<std::uint8_t>& is_observable) {
    for (std::size_t i = first; i < positions.size(); i += step) {
      for (int ray = 0; ray < num_rays; ++ray) {
        mark_ray(marked.cells, is_observable, positions[i], 2.0 * std::numbers::pi * ray / num_rays, max_range_m);
      }
    }
  };
  // Two threads, each with every other position; a cell is observable if one of them marks it.
  auto other_half = std::async(std::launch::async, [&] {
    Grid<std::uint8_t> is_observable(geometry);
    mark_from(1, 2, is_observable);
    return is_observable;
  });
  mark_from(0, 2, marked.is_observable);
  const Grid<std::uint8_t> other = other_half.get();
  std::transform(other.values().begin(), other.values().end(), marked.is_observable.values().begin(),
                 marked.is_observable.values().begin(), std::bit_or<>());
  return marked;
}

OccupancyGrid observable_part(const ReferenceMap& reference) {
  OccupancyGrid part = reference.cells;
  for (std::size_t i = 0; i < part.values().size(); ++i) {
    if (reference.is_observable.values()[i] == 0) part.values()[i] = kUnknown;
  }
  return part;
}

}  // namespace patrol::score
