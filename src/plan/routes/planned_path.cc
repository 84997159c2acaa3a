#include "plan/routes/planned_path.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace patrol::plan {

PlannedPath::PlannedPath(const std::vector<Eigen::Vector2d>& points_m) {
  for (const Eigen::Vector2d& p : points_m) {
    const double step_m = points_m_.empty() ? 0.0 : (p - points_m_.back()).norm();
    if (!points_m_.empty() && step_m < 1e-9) continue;
    along_m_.push_back(length_m() + step_m);
    points_m_.push_back(p);
  }
}

/// Index of the segment that contains `along_m`; at a point, the segment that starts there.
std::size_t PlannedPath::segment_at(double along_m) const {
  const auto after = std::upper_bound(along_m_.begin(), along_m_.end(), along_m);
  const auto index = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, after - along_m_.begin() - 1));
  return std::min(index, points_m_.size() - 2);
}

Eigen::Vector2d PlannedPath::point_at(double along_m) const {
  if (points_m_.size() == 1) return points_m_.front();
  const std::size_t i = segment_at(along_m);
  const double fraction = std::clamp((along_m - along_m_[i]) / (along_m_[i + 1] - along_m_[i]), 0.0, 1.0);
  return points_m_[i] + fraction * (points_m_[i + 1] - points_m_[i]);
}

double PlannedPath::heading_at(double along_m) const {
  if (points_m_.size() == 1) return 0.0;
  const std::size_t i = segment_at(along_m);
  const Eigen::Vector2d ahead = points_m_[i + 1] - points_m_[i];
  return std::atan2(ahead.y(), ahead.x());
}

PathProjection PlannedPath::project(const Eigen::Vector2d& p_map, double from_m, double to_m) const {
  PathProjection best{.along_m = 0.0, .distance_m = std::numeric_limits<double>::infinity()};
  if (points_m_.size() == 1) return {.along_m = 0.0, .distance_m = (p_map - points_m_.front()).norm()};
  for (std::size_t i = segment_at(from_m); i + 1 < points_m_.size() && along_m_[i] <= to_m; ++i) {
    const Eigen::Vector2d segment = points_m_[i + 1] - points_m_[i];
    const double length_m = along_m_[i + 1] - along_m_[i];
    const double first = std::clamp(from_m - along_m_[i], 0.0, length_m);
    const double last = std::clamp(to_m - along_m_[i], first, length_m);
    const double along = std::clamp((p_map - points_m_[i]).dot(segment) / length_m, first, last);
    const double distance_m = (p_map - points_m_[i] - along / length_m * segment).norm();
    if (distance_m < best.distance_m) best = {.along_m = along_m_[i] + along, .distance_m = distance_m};
  }
  return best;
}

std::vector<Pose2> PlannedPath::sample(double step_m) const {
  std::vector<Pose2> poses;
  if (is_empty()) return poses;
  const int steps = std::max(1, static_cast<int>(std::ceil(length_m() / step_m)));
  for (int i = 0; i <= steps; ++i) {
    const double along_m = length_m() * i / steps;
    const Eigen::Vector2d p = point_at(along_m);
    poses.push_back({p.x(), p.y(), heading_at(along_m)});
  }
  return poses;
}

std::vector<std::size_t> join_points(std::size_t count,
                                     const std::function<bool(std::size_t from, std::size_t to)>& may_join) {
  std::vector<std::size_t> kept{0};
  for (std::size_t from = 0; from + 1 < count;) {
    // Search for the farthest point that can be joined: the stride doubles on success, then halves.
    std::size_t to = from + 1;
    for (std::size_t stride = 2; to + stride < count && may_join(from, to + stride); stride *= 2) to += stride;
    for (std::size_t stride = std::bit_ceil(count); stride > 0; stride /= 2) {
      if (to + stride < count && may_join(from, to + stride)) to += stride;
    }
    kept.push_back(to);
    from = to;
  }
  return kept;
}

}  // namespace patrol::plan
