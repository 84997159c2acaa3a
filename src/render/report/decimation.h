#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace patrol::render {

/// Reduces a curve with more than `2 * num_stretches` points. Keeps the minimum and maximum y of each of
/// `num_stretches` equal segments, in order of x, and both end points, so that peaks are preserved. Shorter curves are
/// returned unchanged.
std::vector<Eigen::Vector2d> decimated(const std::vector<Eigen::Vector2d>& curve, std::size_t num_stretches);

/// Reduces a path to the points needed to stay within `tolerance` of all points [Ramer72; Douglas73].
std::vector<Eigen::Vector2d> simplified(const std::vector<Eigen::Vector2d>& path, double tolerance);

}  // namespace patrol::render
