#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace patrol::report {

/// Reduces a curve with more than `2 * num_segments` points. Keeps the minimum and maximum y of each of
/// `num_segments` equal segments, in order of x, and both end points, so that peaks are preserved. Shorter curves are
/// returned unchanged.
std::vector<Eigen::Vector2d> decimate(const std::vector<Eigen::Vector2d>& curve, std::size_t num_segments);

/// Reduces a path to the points needed to stay within `tolerance` of all points [Ramer72], [Douglas73].
std::vector<Eigen::Vector2d> simplify_path(const std::vector<Eigen::Vector2d>& path, double tolerance);

}  // namespace patrol::report
