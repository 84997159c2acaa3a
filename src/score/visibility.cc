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
#include <vector>

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

/// Cells that are crossed by rays from one or more positions.
///
/// A run has 10^9 steps from cell to cell, most of them over free cells that an earlier ray has marked. Blocks of cells
/// that are all free and marked are crossed in one step.
class CrossedCells {
 public:
  explicit CrossedCells(const OccupancyGrid& cells)
      : cells_(cells),
        marked_(cells.geometry()),
        blocks_per_row_((cells.geometry().width + kBlock - 1) / kBlock),
        num_unmarked_(static_cast<std::size_t>(blocks_per_row_ * ((cells.geometry().height + kBlock - 1) / kBlock))) {
    const GridGeometry& geometry = cells.geometry();
    const std::int8_t* value = cells.values().data();
    for (int row = 0; row < geometry.height; ++row) {
      for (int first = 0; first < geometry.width; first += kBlock) {
        std::int32_t& num_unmarked = num_unmarked_[block_of(first, row)];
        for (const std::int8_t* end = value + std::min(kBlock, geometry.width - first); value != end; ++value)
          num_unmarked += *value == kUnknown || *value == kOccupied ? kNeverComplete : 1;
      }
    }
  }

  /// Marks the cells along a ray in order [Amanatides87], up to the first that is occupied or unknown.
  void mark_ray(const Eigen::Vector2d& from_m, double angle_rad, double max_range_m) {
    const GridGeometry& geometry = cells_.geometry();
    const Eigen::Vector2d direction(std::cos(angle_rad), std::sin(angle_rad));
    if (geometry.contains(geometry.cell_at(from_m))) {
      mark_from_inside(from_m, direction, max_range_m);
      return;
    }
    const std::optional<double> outside_m = entry_m(geometry, from_m, direction);
    if (!outside_m || *outside_m > max_range_m) return;
    const Eigen::Vector2d border_m = from_m + *outside_m * direction;
    if (geometry.contains(geometry.cell_at(border_m))) mark_from_inside(border_m, direction, max_range_m - *outside_m);
  }

  Grid<std::uint8_t>& marked() { return marked_; }

 private:
  static constexpr int kBlock = 32;  ///< cells along a side of a block
  static constexpr std::int32_t kNeverComplete = 1 << 20;

  /// Progress of a ray along one axis.
  struct Axis {
    double first_m, stride_m;  ///< range at the first border (infinite: never), and from border to border
    int step;                  ///< 1 or -1
    int first, size;           ///< cell of the origin, and number of cells
    int crossed = 0;           ///< number of borders

    int cell() const { return first + step * crossed; }
    bool is_inside() const { return cell() >= 0 && cell() < size; }
    /// Returns the range at the border after `skipped` further ones.
    double border_m(int skipped) const { return first_m + (crossed + skipped) * stride_m; }
    /// Returns the number of borders up to the one that ends the block or the grid.
    int borders_to_leave() const {
      return step > 0 ? std::min(kBlock - cell() % kBlock, size - cell()) : cell() % kBlock + 1;
    }
    /// Returns the number of further borders before the range; at that range too if `is_closed`.
    int borders_before(double range_m, bool is_closed) const {
      if (!std::isfinite(first_m)) return 0;
      const auto is_before = [&](int skipped) {
        return is_closed ? border_m(skipped) <= range_m : border_m(skipped) < range_m;
      };
      int count = std::max(0, static_cast<int>((range_m - first_m) / stride_m) - crossed + 1);
      while (count > 0 && !is_before(count - 1)) --count;
      while (is_before(count)) ++count;
      return count;
    }
  };

  std::size_t block_of(int col, int row) const {
    return static_cast<std::size_t>(row / kBlock * blocks_per_row_ + col / kBlock);
  }

  Axis axis_of(const Eigen::Vector2d& from_m, const Eigen::Vector2d& direction, int axis, int cell, int size) const {
    const double resolution_m = cells_.geometry().resolution_m;
    const double q = (from_m[axis] - cells_.geometry().origin_m[axis]) / resolution_m;
    const double speed = std::abs(direction[axis]);
    const double to_border = direction[axis] > 0.0 ? std::floor(q) + 1.0 - q : q - std::floor(q);
    constexpr double kNever = std::numeric_limits<double>::infinity();
    const bool moves = speed > 1e-12;
    return {.first_m = moves ? to_border * resolution_m / speed : kNever,
            .stride_m = moves ? resolution_m / speed : 0.0,
            .step = direction[axis] > 0.0 ? 1 : -1,
            .first = cell,
            .size = size};
  }

  void mark_from_inside(const Eigen::Vector2d& from_m, const Eigen::Vector2d& direction, double max_range_m) {
    const GridGeometry& geometry = cells_.geometry();
    const Cell first = geometry.cell_at(from_m);
    Axis col = axis_of(from_m, direction, 0, first.col, geometry.width);
    Axis row = axis_of(from_m, direction, 1, first.row, geometry.height);
    while (col.is_inside() && row.is_inside()) {
      std::int32_t& num_unmarked = num_unmarked_[block_of(col.cell(), row.cell())];
      const bool goes_on =
          num_unmarked == 0 ? skip_block(col, row, max_range_m) : walk_block(col, row, num_unmarked, max_range_m);
      if (!goes_on) return;
    }
  }

  /// Crosses a block at once. Returns false if the range ends in it.
  static bool skip_block(Axis& col, Axis& row, double max_range_m) {
    const int columns = col.borders_to_leave(), rows = row.borders_to_leave();
    const double column_m = col.border_m(columns - 1), row_m = row.border_m(rows - 1);
    if (std::min(column_m, row_m) > max_range_m) return false;
    if (column_m < row_m) {
      row.crossed += row.borders_before(column_m, true);
      col.crossed += columns;
    } else {
      col.crossed += col.borders_before(row_m, false);
      row.crossed += rows;
    }
    return true;
  }

  /// Marks cell after cell up to the end of the block. Returns false if the ray ends in it.
  bool walk_block(Axis& col, Axis& row, std::int32_t& num_unmarked, double max_range_m) {
    const std::ptrdiff_t width = cells_.geometry().width;
    std::ptrdiff_t at = row.cell() * width + col.cell();
    int columns = col.borders_to_leave(), rows = row.borders_to_leave();
    const std::ptrdiff_t row_step = row.step * width;
    const std::int8_t* values = cells_.values().data();
    std::uint8_t* marked = marked_.values().data();
    while (true) {
      const std::int8_t value = values[at];
      if (value == kUnknown) return false;
      if (value == kOccupied) {
        marked[at] = 1;
        mark_neighborhood(cells_, marked_, {static_cast<int>(at % width), static_cast<int>(at / width)});
        return false;
      }
      num_unmarked -= 1 - marked[at];
      marked[at] = 1;
      const double column_m = col.border_m(0), row_m = row.border_m(0);
      if (std::min(column_m, row_m) > max_range_m) return false;
      if (column_m < row_m) {
        ++col.crossed;
        at += col.step;
        if (--columns == 0) return true;
      } else {
        ++row.crossed;
        at += row_step;
        if (--rows == 0) return true;
      }
    }
  }

  const OccupancyGrid& cells_;
  Grid<std::uint8_t> marked_;
  int blocks_per_row_;
  std::vector<std::int32_t> num_unmarked_;  ///< [block]: cells without a mark; large if the block is not all free
};

}  // namespace

ReferenceMap mark_observable(OccupancyGrid reference, const Trajectory& T_world_body, double max_range_m,
                             double spacing_m) {
  const GridGeometry geometry = reference.geometry();
  ReferenceMap result{std::move(reference), {}};
  // Adjacent rays are two cells apart at full range; `mark_neighborhood` fills the gap.
  const double step_rad = 2.0 * geometry.resolution_m / max_range_m;
  const int num_rays = static_cast<int>(std::ceil(2.0 * std::numbers::pi / step_rad));
  const std::vector<Eigen::Vector2d> positions = thin_out(T_world_body, spacing_m);
  const auto mark_from = [&](std::size_t first, std::size_t end) {
    CrossedCells crossed(result.cells);
    for (std::size_t i = first; i < end; ++i) {
      for (int ray = 0; ray < num_rays; ++ray)
        crossed.mark_ray(positions[i], 2.0 * std::numbers::pi * ray / num_rays, max_range_m);
    }
    return std::move(crossed.marked());
  };
  // Two threads, each with one half of the path; a cell is observable if one of them marks it.
  auto second_half = std::async(std::launch::async, mark_from, positions.size() / 2, positions.size());
  result.is_observable = mark_from(0, positions.size() / 2);
  const Grid<std::uint8_t> other = second_half.get();
  std::transform(other.values().begin(), other.values().end(), result.is_observable.values().begin(),
                 result.is_observable.values().begin(), std::bit_or<>());
  return result;
}

OccupancyGrid observable_part(const ReferenceMap& reference) {
  OccupancyGrid part = reference.cells;
  for (std::size_t i = 0; i < part.values().size(); ++i) {
    if (reference.is_observable.values()[i] == 0) part.values()[i] = kUnknown;
  }
  return part;
}

}  // namespace patrol::score
