#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <functional>
#include <vector>

#include "core/frames.h"

namespace patrol::plan {

/// Where a point lies beside a path.
struct PathProjection {
  double along_m = 0.0;     ///< of the nearest point of the path, from its start
  double distance_m = 0.0;  ///< from it
};

/// A polyline in map, measured by the way from its start.
class PlannedPath {
 public:
  PlannedPath() = default;
  explicit PlannedPath(std::vector<Eigen::Vector2d> points_m);

  bool is_empty() const { return points_m_.empty(); }
  double length_m() const { return along_m_.empty() ? 0.0 : along_m_.back(); }
  const std::vector<Eigen::Vector2d>& points_m() const { return points_m_; }
  Eigen::Vector2d point_at(double along_m) const;
  double heading_at(double along_m) const;

  /// The nearest point of the part from `from_m` to `to_m`, so that a path that returns to a place is followed in order.
  PathProjection project(const Eigen::Vector2d& p_map, double from_m, double to_m) const;

  /// Poses at most `step_m` apart, each looking along the path.
  std::vector<Pose2> sample(double step_m) const;

 private:
  std::size_t segment_at(double along_m) const;

  std::vector<Eigen::Vector2d> points_m_;  ///< in map
  std::vector<double> along_m_;            ///< [point]
};

/// The points that stay, of `count` along a route, where straight lines replace the stretches from one to a later one that `may_join` allows: from each
/// the farthest that doubling and halving strides find. The first and the last always stay.
std::vector<std::size_t> join_points(std::size_t count, const std::function<bool(std::size_t from, std::size_t to)>& may_join);

}  // namespace patrol::plan
