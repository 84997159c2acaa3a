#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace patrol::render {

/// Of a curve with more than `2 * num_stretches` points: the least and the greatest y of each of that many stretches of equally many
/// points, in order of x, and both ends. Peaks stay. A shorter curve as it is.
std::vector<Eigen::Vector2d> decimated(const std::vector<Eigen::Vector2d>& curve, std::size_t num_stretches);

/// The points of a path that it needs to stay within `tolerance` of all of them (Ramer 1972; Douglas and Peucker 1973).
std::vector<Eigen::Vector2d> simplified(const std::vector<Eigen::Vector2d>& path, double tolerance);

}  // namespace patrol::render
