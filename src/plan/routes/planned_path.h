#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "core/frames.h"

namespace patrol::plan {

/// Projection of a point onto a path.
struct PathProjection {
  double along_m = 0.0;     ///< arc length of the nearest point of the path
  double distance_m = 0.0;  ///< distance from the nearest point
};

/// Polyline in map, parameterized by the arc length from its start.
class PlannedPath {
 public:
  PlannedPath() = default;
  explicit PlannedPath(const std::vector<Eigen::Vector2d>& points_m);

  bool is_empty() const { return points_m_.empty(); }
  double length_m() const { return along_m_.empty() ? 0.0 : along_m_.back(); }
  const std::vector<Eigen::Vector2d>& points_m() const { return points_m_; }
  Eigen::Vector2d point_at(double along_m) const;
  double heading_at(double along_m) const;

  /// Nearest point of the part from `from_m` to `to_m`. The limits keep the order on a path that returns to a position.
  PathProjection project(const Eigen::Vector2d& p_map, double from_m, double to_m) const;

  /// Poses at most `step_m` apart, with the heading along the path.
  std::vector<Pose2> sample(double step_m) const;

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(points_m_, along_m_);
  }

 private:
  std::size_t segment_at(double along_m) const;

  std::vector<Eigen::Vector2d> points_m_;  ///< in map
  std::vector<double> along_m_;            ///< [point], arc length
};

/// Indices of the points of a route of `count` points that remain after shortening. Straight lines replace segments for
/// which `may_join` is true. From each point, doubling and halving strides search for the farthest one. The first and
/// the last point always remain.
std::vector<std::size_t> join_points(std::size_t count,
                                     const std::function<bool(std::size_t from, std::size_t to)>& may_join);

}  // namespace patrol::plan
