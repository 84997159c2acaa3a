#pragma once

#include <Eigen/Core>

#include <vector>

#include "core/messages.h"

namespace patrol::slam {

/// A point of a scan to be laid on the map.
struct MatchPoint {
  Eigen::Vector2d p_body;  ///< in level
  double range_m;          ///< from the lidar
};

/// Hits, evenly spread in space rather than in angle: neighbouring beams that end within `spacing_m` of the first of them
/// become one point, their mean. A near wall then counts by its length, not by its angle, so that the far ones, which
/// tell the heading, are heard; and all beams' noise is averaged. If more than `max_points` are left, every so many.
std::vector<MatchPoint> select_match_points(const LevelScan& scan, double spacing_m, int max_points);

}  // namespace patrol::slam
