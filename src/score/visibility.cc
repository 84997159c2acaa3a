#include "score/visibility.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace patrol::score {
namespace {

/// Visits the cells along a ray in order [Amanatides87].
class CellWalk {
 public:
  CellWalk(const GridGeometry& geometry, const Eigen::Vector2d& from_m, const Eigen::Vector2d& direction)
      : cell_(geometry.cell_at(from_m)), step_{sign(direction.x()), sign(direction.y())} {
    const Eigen::Vector2d q = (from_m - geometry.origin_m) / geometry.resolution_m;
    for (int axis = 0; axis < 2; ++axis) {
      const double speed = std::abs(direction[axis]);
      const double to_border =
          direction[axis] > 0.0 ? std::floor(q[axis]) + 1.0 - q[axis] : q[axis] - std::floor(q[axis]);
      const bool moves = speed > 1e-12;
      stride_[axis] = moves ? geometry.resolution_m / speed : std::numeric_limits<double>::infinity();
      next_[axis] = moves ? to_border * geometry.resolution_m / speed : std::numeric_limits<double>::infinity();
    }
  }

  Cell cell() const { return cell_; }
  double entered_at_m() const { return entered_at_m_; }

  void advance() {
    if (next_[0] < next_[1]) {
      entered_at_m_ = next_[0];
      next_[0] += stride_[0];
      cell_.col += step_.col;
    } else {
      entered_at_m_ = next_[1];
      next_[1] += stride_[1];
      cell_.row += step_.row;
    }
  }

 private:
  static int sign(double value) { return value > 0.0 ? 1 : -1; }

  Cell cell_;
  Cell step_;
  double next_[2] = {}, stride_[2] = {};
  double entered_at_m_ = 0.0;
};

std::vector<Eigen::Vector2d> thin_out(const Trajectory& T_world_body, double spacing_m) {
  std::vector<Eigen::Vector2d> positions;
  for (const StampedPose& entry : T_world_body) {
    const Eigen::Vector2d p = entry.pose.position.head<2>();
    if (positions.empty() || (p - positions.back()).norm() >= spacing_m) positions.push_back(p);
  }
  return positions;
}

void mark_neighborhood(ReferenceMap& reference, Cell hit) {
  for (int row = hit.row - 1; row <= hit.row + 1; ++row) {
    for (int col = hit.col - 1; col <= hit.col + 1; ++col) {
      if (reference.cells.contains({col, row}) && reference.cells.at({col, row}) == kOccupied) {
        reference.is_observable.at({col, row}) = 1;
      }
    }
  }
}

void mark_ray(ReferenceMap& reference, const Eigen::Vector2d& from_m, double angle_rad, double max_range_m) {
  CellWalk walk(reference.cells.geometry(), from_m, {std::cos(angle_rad), std::sin(angle_rad)});
  for (; reference.cells.contains(walk.cell()) && walk.entered_at_m() <= max_range_m; walk.advance()) {
    const std::int8_t value = reference.cells.at(walk.cell());
    if (value == kUnknown) return;
    reference.is_observable.at(walk.cell()) = 1;
    if (value == kOccupied) return mark_neighborhood(reference, walk.cell());
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
  for (const Eigen::Vector2d& p_world : thin_out(T_world_body, spacing_m)) {
    for (int ray = 0; ray < num_rays; ++ray) {
      mark_ray(marked, p_world, 2.0 * std::numbers::pi * ray / num_rays, max_range_m);
    }
  }
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
