#include "inspect/lining/reference_lining.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "core/geometry/angles.h"
#include "core/geometry/linear_algebra.h"
#include "inspect/lining/robust_mean.h"

namespace patrol::inspect {
namespace {

// Minimum band around the median of a cell; points within it always belong to the lining.
constexpr double kMinBand_m = 0.006;
constexpr double kMinRadius_m = 0.15, kMaxRadius_m = 0.6;
constexpr int kMinNeighbors = 3;
// Prior standard deviation of the slope against the design: 10 mm/m. Standard deviation of a point: 2 mm.
constexpr double kSlopePrior_m2 = 0.002 * 0.002 / (0.01 * 0.01);

}  // namespace

ReferenceLining::ReferenceLining(const LiningInMap& lining, const LiningGrid& grid,
                                 const std::vector<DownsampledPoint>& points_map, const LiningSettings& settings)
    : grid_(grid),
      arc_per_deg_m_(to_rad(lining.design.crown_radius_m)),
      cells_(static_cast<std::size_t>(grid.cells())) {
  for (const DownsampledPoint& sample : points_map) {
    const LiningPoint point = lining_point(lining, sample.p);
    const int cell = grid.cell_at(point);
    if (cell < 0 || std::abs(point.inward_m) > settings.design_tolerance_m) continue;
    cells_[static_cast<std::size_t>(cell)].points.push_back(
        {point.chainage_m, point.clock_deg * arc_per_deg_m_, point.inward_m});
  }
  const double area_m2 = (grid.ring_length_m - 2.0 * grid.joint_margin_m) * grid.sector_deg * arc_per_deg_m_;
  for (Cell& cell : cells_) {
    std::vector<double> inward;
    for (const Point& point : cell.points) inward.push_back(point.inward_m);
    const double middle = median_of(inward), design_tolerance_m = std::max(kMinBand_m, 4.0 * mad_std(inward, middle));
    std::erase_if(cell.points,
                  [&](const Point& point) { return std::abs(point.inward_m - middle) > design_tolerance_m; });
    if (cell.points.empty()) continue;
    cell.radius_m =
        std::clamp(2.0 * std::sqrt(area_m2 / static_cast<double>(cell.points.size())), kMinRadius_m, kMaxRadius_m);
  }
  for (int index = 0; index < grid.cells(); ++index) {
    Cell& cell = cells_[static_cast<std::size_t>(index)];
    double squares = 0.0;
    int count = 0;
    for (const Point& point : cell.points) {
      const auto others = inward_m(point.chainage_m, point.arc_m, index, &point);
      if (!others) continue;
      squares += (point.inward_m - *others) * (point.inward_m - *others);
      ++count;
    }
    if (count > 0) cell.var_m2 = squares / count / count;
  }
}

std::optional<double> ReferenceLining::inward_m(const LiningPoint& point, int cell) const {
  return inward_m(point.chainage_m, point.clock_deg * arc_per_deg_m_, cell, nullptr);
}

std::optional<double> ReferenceLining::inward_m(double chainage_m, double arc_m, int cell, const Point* without) const {
  const double radius_m2 =
      cells_[static_cast<std::size_t>(cell)].radius_m * cells_[static_cast<std::size_t>(cell)].radius_m;
  Eigen::Matrix3d H = Eigen::Vector3d(0.0, kSlopePrior_m2, kSlopePrior_m2).asDiagonal();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  int neighbors = 0;
  const int sector = grid_.sector_of(cell), low = std::max(0, sector - 1),
            high = std::min(grid_.sectors() - 1, sector + 1);
  for (int other = cell - sector + low; other <= cell - sector + high; ++other) {
    for (const Point& point : cells_[static_cast<std::size_t>(other)].points) {
      const double x = point.chainage_m - chainage_m, y = point.arc_m - arc_m, ratio = (x * x + y * y) / radius_m2;
      if (ratio >= 1.0 || &point == without) continue;
      const double weight = (1.0 - ratio) * (1.0 - ratio);
      const Eigen::Vector3d J(1.0, x, y);
      H += weight * J * J.transpose();
      b += weight * point.inward_m * J;
      ++neighbors;
    }
  }
  if (neighbors < kMinNeighbors) return std::nullopt;
  return solve_symmetric(H, b)[0];
}

}  // namespace patrol::inspect
