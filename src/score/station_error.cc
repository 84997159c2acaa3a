#include "score/station_error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Dense>

#include "core/geometry/angles.h"
#include "core/geometry/linear_algebra.h"
#include "score/arrival_score.h"
#include "score/map_error.h"

namespace patrol::score {
namespace {

constexpr double kMaxDistance_m = 0.5;  // cells farther from every true surface are not used
constexpr double kRobust_m = 0.05;      // scale of the Cauchy weight
constexpr std::size_t kMinPoints = 30;
constexpr int kIterations = 20;
// directions below this fraction of the largest information eigenvalue are not moved
constexpr double kDegenerateRatio = 0.03;

// Search for displacements outside the convergence basin of the fit from the identity.
constexpr double kSearch_m = 3.0;  // maximum along either axis
constexpr double kSearchStep_m = 0.1;
constexpr double kSearchRobust_m = 0.1;     // scale of the Cauchy weight during the search, wider to bridge the steps
constexpr double kSearchYawStep_deg = 2.0;  // step of the yaw
constexpr int kSearchYawSteps = 2;
constexpr std::size_t kMaxSearchPoints = 300;
// the smaller of two motions counts when its score is at least this fraction of the other's
constexpr double kEquivalentScoreRatio = 0.9;

std::vector<Eigen::Vector2d> points_near(const OccupancyGrid& built, const Pose2& T_world_map,
                                         const Eigen::Vector2d& center, double radius_m) {
  std::vector<Eigen::Vector2d> near;
  for (const Eigen::Vector2d& p_map : occupied_points(built)) {
    const Eigen::Vector2d p_world = T_world_map * p_map;
    if ((p_world - center).norm() <= radius_m) near.emplace_back(p_world - center);
  }
  return near;
}

/// One Gauss-Newton step of a motion about `center`: x, y in m, rotation as arc length at `radius_m`.
Eigen::Vector3d step(const DistanceField& field, const std::vector<Eigen::Vector2d>& points,
                     const Eigen::Vector2d& center, const Pose2& motion, double radius_m) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  for (const Eigen::Vector2d& point : points) {
    const Eigen::Vector2d moved = motion * point;
    const double distance = field.distance_m(center + moved);
    if (distance > kMaxDistance_m) continue;
    const Eigen::Vector2d slope = field.gradient(center + moved);
    const Eigen::Vector2d arm = moved - motion.position();
    const Eigen::Vector3d row(slope.x(), slope.y(), (slope.y() * arm.x() - slope.x() * arm.y()) / radius_m);
    const double weight = 1.0 / (1.0 + distance * distance / (kRobust_m * kRobust_m));
    information += weight * row * row.transpose();
    gradient += weight * distance * row;
  }
  const SymmetricEigen<3> eigen = symmetric_eigen(information);
  Eigen::Vector3d result = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const double value = eigen.values[i];
    if (value <= kDegenerateRatio * eigen.values[2]) continue;
    result -= eigen.vectors.col(i) * (eigen.vectors.col(i).dot(gradient) / value);
  }
  return result;
}

Pose2 refine(const DistanceField& field, const std::vector<Eigen::Vector2d>& points, const Eigen::Vector2d& center,
             Pose2 motion, double radius_m) {
  for (int i = 0; i < kIterations; ++i) {
    const Eigen::Vector3d change = step(field, points, center, motion, radius_m);
    motion = {motion.x + change.x(), motion.y + change.y(), motion.yaw + change.z() / radius_m};
    if (change.norm() < 1e-5) break;
  }
  return motion;
}

/// Points rotated by an angle, for the scores of many translations.
class RotatedPoints {
 public:
  RotatedPoints(const std::vector<Eigen::Vector2d>& points, double yaw) {
    const double c = std::cos(yaw), s = std::sin(yaw);
    for (const Eigen::Vector2d& p : points) points_.push_back({c * p.x(), s * p.y(), s * p.x(), c * p.y()});
  }

  /// Mean weight of the points after a translation: 1 when all lie on surfaces, near 0 when all are much farther than
  /// `robust_m`. A score below `min_score` may be replaced by a lower one.
  double mean_weight(const DistanceField& field, const Eigen::Vector2d& center, const Eigen::Vector2d& translation,
                     double robust_m, double min_score = 0.0) const {
    constexpr std::size_t kPointsPerCheck = 16;
    constexpr double kRounding = 1e-9;
    const auto count = static_cast<double>(points_.size());
    double sum = 0.0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const bool is_hopeless = sum + (count - static_cast<double>(i)) < (min_score - kRounding) * count;
      if (i % kPointsPerCheck == 0 && is_hopeless) break;
      const Products& p = points_[i];
      const Eigen::Vector2d moved(translation.x() + p.cx - p.sy, translation.y() + p.sx + p.cy);
      const double ratio = field.distance_m(center + moved) / robust_m;
      sum += 1.0 / (1.0 + ratio * ratio);
    }
    return sum / count;
  }

 private:
  /// Products of a point's coordinates with cosine and sine.
  struct Products {
    double cx, sy, sx, cy;
  };
  std::vector<Products> points_;
};

double mean_weight(const DistanceField& field, const std::vector<Eigen::Vector2d>& points,
                   const Eigen::Vector2d& center, const Pose2& motion, double robust_m) {
  return RotatedPoints(points, motion.yaw).mean_weight(field, center, motion.position(), robust_m);
}

/// Smallest motion of a grid whose score is within `kEquivalentScoreRatio` of the best. Along a straight wall many
/// motions fit equally well; the smallest is the one across the wall.
Pose2 search(const DistanceField& field, const std::vector<Eigen::Vector2d>& all, const Eigen::Vector2d& center,
             double radius_m) {
  std::vector<Eigen::Vector2d> points;
  const std::size_t stride = all.size() / kMaxSearchPoints + 1;
  for (std::size_t i = 0; i < all.size(); i += stride) points.push_back(all[i]);

  struct Candidate {
    Pose2 motion;
    double score;
    double size_m;
  };
  std::vector<Candidate> candidates;
  double best = mean_weight(field, points, center, {}, kSearchRobust_m);
  const int steps = static_cast<int>(std::lround(kSearch_m / kSearchStep_m));
  for (int turn = -kSearchYawSteps; turn <= kSearchYawSteps; ++turn) {
    const double yaw = turn * to_rad(kSearchYawStep_deg);
    const RotatedPoints rotated(points, yaw);
    for (int i = -steps; i <= steps; ++i) {
      for (int j = -steps; j <= steps; ++j) {
        const Pose2 motion{kSearchStep_m * i, kSearchStep_m * j, yaw};
        const double score =
            rotated.mean_weight(field, center, motion.position(), kSearchRobust_m, kEquivalentScoreRatio * best);
        candidates.push_back({motion, score, std::hypot(motion.x, motion.y, yaw * radius_m)});
        best = std::max(best, score);
      }
    }
  }
  std::erase_if(candidates, [&](const Candidate& candidate) { return candidate.score < kEquivalentScoreRatio * best; });
  const auto is_smaller = [](const Candidate& a, const Candidate& b) { return a.size_m < b.size_m; };
  return std::min_element(candidates.begin(), candidates.end(), is_smaller)->motion;
}

}  // namespace

std::optional<double> map_displacement_m(const OccupancyGrid& built, const Pose2& T_world_map,
                                         const DistanceField& reference, const Eigen::Vector2d& p_world_target,
                                         double radius_m) {
  const std::vector<Eigen::Vector2d> points = points_near(built, T_world_map, p_world_target, radius_m);
  if (points.size() < kMinPoints) return std::nullopt;
  if (!std::isfinite(reference.distance_m(p_world_target))) return std::nullopt;
  const auto score = [&](const Pose2& motion) {
    return mean_weight(reference, points, p_world_target, motion, kRobust_m);
  };
  const Pose2 near = refine(reference, points, p_world_target, {}, radius_m);
  if (score(near) >= kEquivalentScoreRatio) return near.position().norm();  // the score is at most 1
  const Pose2 far =
      refine(reference, points, p_world_target, search(reference, points, p_world_target, radius_m), radius_m);
  const bool is_near_as_good = score(near) >= kEquivalentScoreRatio * score(far);
  return (is_near_as_good ? near : far).position().norm();
}

Pose2 fit_map_to_reference(const OccupancyGrid& built, std::span<const Pose2> T_world_map,
                           const DistanceField& reference) {
  const std::vector<Eigen::Vector2d> cells = occupied_points(built);
  if (cells.size() < kMinPoints) return T_world_map.front();
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& cell : cells) mean += cell / static_cast<double>(cells.size());
  double squares_m2 = 0.0;
  for (const Eigen::Vector2d& cell : cells) squares_m2 += (cell - mean).squaredNorm();
  const double radius_m = std::sqrt(squares_m2 / static_cast<double>(cells.size()));

  Pose2 best = T_world_map.front();
  double best_score = -1.0;
  for (const Pose2& start : T_world_map) {
    const Eigen::Vector2d center = start * mean;
    std::vector<Eigen::Vector2d> points;
    points.reserve(cells.size());
    for (const Eigen::Vector2d& cell : cells) points.emplace_back(start * cell - center);
    const Pose2 T_world_center{center.x(), center.y(), 0.0};
    for (const Pose2& motion : {Pose2{}, refine(reference, points, center, {}, radius_m)}) {
      const double score = mean_weight(reference, points, center, motion, kSearchRobust_m);
      if (score <= best_score) continue;
      best_score = score;
      best = T_world_center * motion * T_world_center.inverse() * start;
    }
  }
  return best;
}

std::vector<StationError> station_errors(const Route& route_in_world, const std::vector<Event>& events,
                                         const Pose2& T_world_map, const MapInSite& map, const Trajectory& T_world_body,
                                         const OccupancyGrid& built, const DistanceField& reference) {
  std::vector<StationError> errors;
  for (const Station& station : route_in_world.stations) {
    StationError error;
    error.name = station.name;
    error.map_error_m = map_displacement_m(built, T_world_map, reference, station.p_route_target.head<2>());
    for (const Event& event : events) {
      if (event.kind != EventKind::kStationReached || event.subject != station.name) continue;
      const Pose2 T_world_truth = true_pose_of(event, T_world_body);
      const bool is_true = is_arrival(T_world_truth.position(), station.T_route_body.position(), station.accuracy_m);
      if (error.is_reached && !is_true) continue;
      const Pose2 T_world_estimate = map.at(event.stamp).T_site_map * event.T_map_body;
      error.is_reported = true;
      error.is_reached = is_true;
      error.position_error_m = (T_world_estimate.position() - T_world_truth.position()).norm();
      error.heading_error_deg = to_deg(std::abs(wrap_angle(T_world_estimate.yaw - T_world_truth.yaw)));
      error.goal_position_error_m = (T_world_truth.position() - station.T_route_body.position()).norm();
    }
    errors.push_back(error);
  }
  return errors;
}

}  // namespace patrol::score
