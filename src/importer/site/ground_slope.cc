#include "importer/site/ground_slope.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "core/geometry/angles.h"
#include "importer/site/imported_site.h"

namespace patrol::importer {
namespace {

constexpr double kSteep_rad = 2.0 * kDegree;

}  // namespace

GroundSlopes slopes_of(const Grid<float>& height_m, const std::vector<char>& is_ground) {
  constexpr double kBaseline_m = 1.0;
  const GridGeometry& grid = height_m.geometry();
  const int reach = std::max(1, static_cast<int>(std::lround(0.5 * kBaseline_m / grid.resolution_m)));
  const double length_m = 2.0 * reach * grid.resolution_m;
  const auto is_known = [&](Cell cell) {
    const std::size_t index =
        static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(grid.width) + static_cast<std::size_t>(cell.col);
    return is_ground.empty() || is_ground[index] != 0;
  };
  GroundSlopes slopes;
  std::size_t num = 0, num_steep = 0;
  for (int row = reach; row + reach < grid.height; ++row) {
    for (int col = reach; col + reach < grid.width; ++col) {
      const Cell west{col - reach, row}, east{col + reach, row}, south{col, row - reach}, north{col, row + reach};
      if (!is_known({col, row}) || !is_known(west) || !is_known(east) || !is_known(south) || !is_known(north)) continue;
      const double along_x = double{height_m.at(east)} - double{height_m.at(west)},
                   along_y = double{height_m.at(north)} - double{height_m.at(south)};
      const double slope_rad = std::atan(std::hypot(along_x, along_y) / length_m);
      slopes.max_rad = std::max(slopes.max_rad, slope_rad);
      ++num;
      num_steep += slope_rad > kSteep_rad ? 1 : 0;
    }
  }
  if (num > 0) slopes.steep_ratio = static_cast<double>(num_steep) / static_cast<double>(num);
  return slopes;
}

void add_slope_rows(ImportedSite& site) {
  constexpr double kMinSteepRatio = 0.05;
  for (const SiteShape& shape : site.shapes) {
    const bool has_contact = shape.use == ShapeUse::kSolid || shape.use == ShapeUse::kContactOnly;
    if (shape.type != SiteShapeType::kHeightField || !has_contact) continue;
    const GroundSlopes slopes = slopes_of(shape.height_field.height_m, shape.height_field.is_ground);
    if (slopes.steep_ratio < kMinSteepRatio) continue;
    site.assumptions.push_back(
        {"slopes",
         fmt::format("the ground has slopes of up to {:.1f} degrees, and {:.0f} % of it is steeper than {:.0f} "
                     "degrees: the built-in SLAM assumes level ground and may be off by meters",
                     to_deg(slopes.max_rad), 100.0 * slopes.steep_ratio, to_deg(kSteep_rad)),
         "a stack of your own (--stack), or a given map (key map)"});
  }
}

}  // namespace patrol::importer
