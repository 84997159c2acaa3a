#include "score/driven_clearance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/frames.h"
#include "core/geometry/segment.h"
#include "score/map_error.h"
#include "score/statistics.h"

namespace patrol::score {
namespace {

/// Distance from a point to the outline, 0 inside it.
double distance_to_outline(const Eigen::Vector2d& p, const std::vector<Eigen::Vector2d>& outline) {
  bool is_inside = true;
  double min_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d& from = outline[i];
    const Eigen::Vector2d side = outline[(i + 1) % outline.size()] - from, to_p = p - from;
    if (side.x() * to_p.y() - side.y() * to_p.x() < 0.0) is_inside = false;
    min_m = std::min(min_m, distance_to_segment(p, from, from + side));
  }
  return is_inside ? 0.0 : min_m;
}

/// Returns points of the lines at most 2 cm apart.
std::vector<Eigen::Vector2d> points_on(const std::vector<std::vector<Eigen::Vector2d>>& lines) {
  constexpr double kStep_m = 0.02;
  std::vector<Eigen::Vector2d> points;
  for (const std::vector<Eigen::Vector2d>& line : lines) {
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      const Eigen::Vector2d along = line[i + 1] - line[i];
      const int steps = std::max(1, static_cast<int>(std::ceil(along.norm() / kStep_m)));
      for (int step = 0; step <= steps; ++step) points.emplace_back(line[i] + along * step / steps);
    }
  }
  return points;
}

/// Returns the distance from the outline to the nearest point, at path positions at least `spacing_m` apart.
std::vector<double> clearances_m(const Trajectory& T_world_body, const std::vector<Eigen::Vector2d>& footprint_m,
                                 const std::vector<Eigen::Vector2d>& points_in_world, double spacing_m) {
  double reach_m = 0.0;
  for (const Eigen::Vector2d& corner : footprint_m) reach_m = std::max(reach_m, corner.norm());
  std::vector<double> clearances;
  Eigen::Vector2d last = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  for (const StampedPose& stamped : T_world_body) {
    const Pose2 T_world = to_pose2(stamped.pose);
    if ((T_world.position() - last).norm() < spacing_m) continue;
    last = T_world.position();
    const Pose2 T_body_world = T_world.inverse();
    double clearance_m = kMaxClearance_m;
    for (const Eigen::Vector2d& p : points_in_world) {
      const Eigen::Vector2d d = (p - last).cwiseAbs();
      if (d.maxCoeff() < clearance_m + reach_m)
        clearance_m = std::min(clearance_m, distance_to_outline(T_body_world * p, footprint_m));
    }
    clearances.push_back(clearance_m);
  }
  return clearances;
}

}  // namespace

DrivenClearance driven_clearance(const Trajectory& T_world_body, const std::vector<Eigen::Vector2d>& footprint_m,
                                 const OccupancyGrid& map_in_world,
                                 const std::vector<std::vector<Eigen::Vector2d>>& keep_out_lines_in_world,
                                 double spacing_m) {
  if (T_world_body.empty() || footprint_m.size() < 3) return {};
  const std::vector<double> clearances =
      clearances_m(T_world_body, footprint_m, occupied_points(map_in_world), spacing_m);
  DrivenClearance score{.mean_m = mean(clearances),
                        .p05_m = percentile(clearances, 0.05),
                        .min_m = *std::min_element(clearances.begin(), clearances.end()),
                        .num_positions = clearances.size(),
                        .keep_out_min_m = std::nullopt};
  if (keep_out_lines_in_world.empty()) return score;
  const std::vector<double> from_lines =
      clearances_m(T_world_body, footprint_m, points_on(keep_out_lines_in_world), spacing_m);
  score.keep_out_min_m = *std::min_element(from_lines.begin(), from_lines.end());
  return score;
}

}  // namespace patrol::score
