#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/messages.h"

namespace patrol::slam {

/// Scan point for registration to the map.
struct MatchPoint {
  Eigen::Vector2d p_body;  ///< in level (gravity-aligned body frame)
  double range_m;          ///< distance from the lidar
};

/// Downsamples the hits of a scan uniformly in space: consecutive beams that end within `spacing_m` of the first of
/// them are averaged. A near wall is thus weighted by its length, not by its angle; far walls, which constrain the
/// heading, keep their weight. If more than `max_points` remain, a regular subset is returned.
std::vector<MatchPoint> downsample_scan(const LevelScan& scan, double spacing_m, int max_points);

/// Returns the positions of a regular subset of at most `max_points` points.
std::vector<Eigen::Vector2d> positions_of(const std::vector<MatchPoint>& points, int max_points);

}  // namespace patrol::slam
