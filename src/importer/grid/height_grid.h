#pragma once

#include <Eigen/Core>

#include "core/grid.h"

namespace patrol::importer {

/// Returns the height at a point, interpolated between the centers of cells; beyond the outermost centers, that of the
/// nearest point between them.
double interpolated(const Grid<float>& height_m, const Eigen::Vector2d& p_m);

/// Replaces unknown cells by smooth interpolation of the known ones. At least one must be known.
void fill_smoothly(Grid<float>& values, const Grid<char>& is_known);

}  // namespace patrol::importer
