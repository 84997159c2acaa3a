#include "slam/local_line.h"

#include "slam/line_fit.h"

namespace patrol::slam {

std::optional<LocalLine> fit_local_line(const GridMap& map, const Eigen::Vector2d& p_map, int radius_cells) {
  LineFit fit;
  if (!fit_line(map, p_map, radius_cells, fit)) return std::nullopt;
  return LocalLine{.point_map = p_map + Eigen::Vector2d(fit.mean_x_m, fit.mean_y_m),
                   .normal_map = {fit.normal_x, fit.normal_y},
                   .normal_var_m2 = fit.normal_var_m2,
                   .linearity = fit.linearity,
                   .num_hits = fit.num_hits};
}

}  // namespace patrol::slam
