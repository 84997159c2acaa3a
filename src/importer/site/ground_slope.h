#pragma once

#include <vector>

#include "core/grid.h"
#include "importer/assumptions.h"

namespace patrol::importer {

struct ImportedSite;

/// Slopes of a ground over 1 m, or over two cells if these are longer.
struct GroundSlopes {
  double max_rad = 0.0;
  double steep_ratio = 0.0;  ///< ratio of the cells with a slope above 2 degrees to those with a slope
};

/// Returns the slopes at the cells of a ground whose neighbors at half the distance belong to it. `is_ground`: cells of
/// the ground, [cell]; empty: all.
GroundSlopes slopes_of(const Grid<float>& height_m, const std::vector<char>& is_ground);

/// Adds a row for each height field with contact of which at least 5 % is steeper than 2 degrees: the built-in SLAM
/// assumes level ground.
void add_slope_rows(ImportedSite& site);

}  // namespace patrol::importer
