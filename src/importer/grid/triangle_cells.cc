#include "importer/grid/triangle_cells.h"

namespace patrol::importer {

std::pair<double, double> range_on_line(const std::array<Eigen::Vector3d, 3>& corners, double y) {
  double lower = std::numeric_limits<double>::infinity(), upper = -lower;
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector3d &a = corners[k], &b = corners[(k + 1) % 3];
    if (std::min(a.y(), b.y()) > y + 1e-9 || std::max(a.y(), b.y()) < y - 1e-9) continue;
    const double rise = b.y() - a.y();
    if (std::abs(rise) < 1e-12) {
      lower = std::min({lower, a.x(), b.x()}), upper = std::max({upper, a.x(), b.x()});
      continue;
    }
    const double x = a.x() + std::clamp((y - a.y()) / rise, 0.0, 1.0) * (b.x() - a.x());
    lower = std::min(lower, x), upper = std::max(upper, x);
  }
  return {lower, upper};
}

}  // namespace patrol::importer
