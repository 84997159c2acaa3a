#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "slam/grid_map.h"

namespace patrol::slam {

/// Line of fit_local_line() in scalars: vectors of two numbers would be packed and unpacked for every cell.
struct LineFit {
  double mean_x_m = 0.0, mean_y_m = 0.0;  ///< weighted mean of the mean hits, relative to the point
  double normal_x = 0.0, normal_y = 0.0;
  double normal_var_m2 = 0.0;
  double linearity = 0.0;
  int num_hits = 0;
};

/// `condition ? a : b` without a branch, for conditions that are hard to predict.
inline double select(bool condition, double a, double b) {
  const std::uint64_t mask = -static_cast<std::uint64_t>(condition);
  return std::bit_cast<double>((std::bit_cast<std::uint64_t>(a) & mask) | (std::bit_cast<std::uint64_t>(b) & ~mask));
}

/// Fits the line of fit_local_line() (local_line.h). Returns false if there is none.
inline bool fit_line(const GridMap& map, const Eigen::Vector2d& p_map, int radius_cells, LineFit& fit) {
  const double px = p_map.x(), py = p_map.y();
  int num_cells = 0, num_hits = 0;
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0, syy = 0.0;
  map.for_each_surface_near(map.cell_at(p_map), radius_cells, [&](double mean_x_m, double mean_y_m, int hits) {
    const double x = mean_x_m - px, y = mean_y_m - py, w = hits;
    const double wx = w * x, wy = w * y;
    ++num_cells;
    num_hits += hits;
    n += w;
    sx += wx;
    sy += wy;
    sxx += wx * x;
    sxy += wx * y;
    syy += wy * y;
  });
  if (num_cells < 3) return false;

  // 2 x 2 scatter matrix in closed form: the smaller eigenvalue is the roughness, its eigenvector the normal.
  const double mx = sx / n, my = sy / n;
  const double cxx = sxx / n - mx * mx, cxy = sxy / n - mx * my, cyy = syy / n - my * my;
  const double half_difference = 0.5 * (cxx - cyy);
  const double root = std::sqrt(half_difference * half_difference + cxy * cxy);
  const double middle = 0.5 * (cxx + cyy);
  const double across = std::max(0.0, middle - root), along = middle + root;
  const double min_along = 0.25 * map.resolution_m() * map.resolution_m();
  if (along < min_along) return false;
  // (cxy, across - cxx) and (across - cyy, cxy) are both parallel to the eigenvector; the longer is better conditioned.
  const double longer = -std::abs(half_difference) - root;
  const bool is_y_longer = half_difference > 0.0;
  const double nx = select(is_y_longer, cxy, longer), ny = select(is_y_longer, longer, cxy);
  const double length = std::sqrt(nx * nx + ny * ny);
  if (!(length > 0.0)) return false;
  fit = {.mean_x_m = mx,
         .mean_y_m = my,
         .normal_x = nx / length,
         .normal_y = ny / length,
         .normal_var_m2 = across,
         .linearity = 1.0 - across / along,
         .num_hits = num_hits};
  return true;
}

}  // namespace patrol::slam
