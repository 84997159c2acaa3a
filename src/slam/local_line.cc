#include "slam/local_line.h"

#include <cmath>

namespace patrol::slam {

std::optional<LocalLine> fit_local_line(const GridMap& map, const Eigen::Vector2d& p_map, int radius_cells) {
  int num_cells = 0, num_hits = 0;
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0, syy = 0.0;
  map.for_each_surface_near(map.cell_at(p_map), radius_cells, [&](const Eigen::Vector2d& mean, int hits) {
    const double x = mean.x() - p_map.x(), y = mean.y() - p_map.y(), w = hits;
    ++num_cells;
    num_hits += hits;
    n += w;
    sx += w * x;
    sy += w * y;
    sxx += w * x * x;
    sxy += w * x * y;
    syy += w * y * y;
  });
  if (num_cells < 3) return std::nullopt;

  // 2 x 2 scatter matrix in closed form: the smaller eigenvalue is the roughness, its eigenvector the normal.
  const double mx = sx / n, my = sy / n;
  const double cxx = sxx / n - mx * mx, cxy = sxy / n - mx * my, cyy = syy / n - my * my;
  const double half_difference = 0.5 * (cxx - cyy);
  const double root = std::sqrt(half_difference * half_difference + cxy * cxy);
  const double middle = 0.5 * (cxx + cyy);
  const double across = std::max(0.0, middle - root), along = middle + root;
  const double min_along = 0.25 * map.resolution_m() * map.resolution_m();
  if (along < min_along) return std::nullopt;
  // (cxy, across - cxx) and (across - cyy, cxy) are both parallel to the eigenvector; the longer is better conditioned.
  Eigen::Vector2d normal = half_difference > 0.0 ? Eigen::Vector2d(cxy, -half_difference - root)
                                                 : Eigen::Vector2d(half_difference - root, cxy);
  const double length = normal.norm();
  if (!(length > 0.0)) return std::nullopt;
  normal /= length;
  return LocalLine{.point_map = p_map + Eigen::Vector2d(mx, my),
                   .normal_map = normal,
                   .normal_var_m2 = across,
                   .linearity = 1.0 - across / along,
                   .num_hits = num_hits};
}

}  // namespace patrol::slam
