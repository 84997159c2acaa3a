#include "report/decimation.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "core/geometry/segment.h"

namespace patrol::report {

std::vector<Eigen::Vector2d> decimate(const std::vector<Eigen::Vector2d>& curve, std::size_t num_segments) {
  if (curve.size() <= 2 * num_segments) return curve;
  const auto is_lower = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.y() < b.y(); };
  std::vector<Eigen::Vector2d> kept = {curve.front()};
  const auto keep = [&](const Eigen::Vector2d& point) {
    if (point.x() > kept.back().x()) kept.push_back(point);
  };
  for (std::size_t i = 0; i < num_segments; ++i) {
    const auto begin = curve.begin() + static_cast<std::ptrdiff_t>(i * curve.size() / num_segments);
    const auto end = curve.begin() + static_cast<std::ptrdiff_t>((i + 1) * curve.size() / num_segments);
    const auto [min, max] = std::minmax_element(begin, end, is_lower);
    keep(*std::min(min, max));
    keep(*std::max(min, max));
  }
  keep(curve.back());
  return kept;
}

std::vector<Eigen::Vector2d> simplify_path(const std::vector<Eigen::Vector2d>& path, double tolerance) {
  if (path.size() < 3) return path;
  std::vector<bool> is_kept(path.size(), false);
  is_kept.front() = is_kept.back() = true;
  // explicit stack: recursion is deep for long paths
  std::vector<std::pair<std::size_t, std::size_t>> open = {{0, path.size() - 1}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    double max_distance = tolerance;
    std::size_t split = first;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double distance = distance_to_segment(path[i], path[first], path[last]);
      if (distance > max_distance) std::tie(max_distance, split) = std::pair(distance, i);
    }
    if (split == first) continue;
    is_kept[split] = true;
    open.emplace_back(first, split);
    open.emplace_back(split, last);
  }
  std::vector<Eigen::Vector2d> kept;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (is_kept[i]) kept.push_back(path[i]);
  }
  return kept;
}

}  // namespace patrol::report
