#include "score/pose/trajectory_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Dense>
#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "score/pose/interpolation_limit.h"
#include "score/statistics.h"

namespace patrol::score {
namespace {

constexpr double kSegment_m = 1.0;
constexpr Time kCoveredWithin = std::chrono::milliseconds(200);
constexpr double kLevel_m = 1e-6;  ///< heights that differ less are equal

struct RelativeError {
  std::vector<double> translation_m;
  std::vector<double> rotation_rad;
};

/// Number of holes of the trajectory that end at or before each pose.
std::vector<std::size_t> holes_before(const std::vector<MatchedPose>& poses, const Trajectory& trajectory) {
  const Time max_step = max_interpolated_step(trajectory);
  std::vector<std::size_t> counts;
  counts.reserve(poses.size());
  std::size_t next = 1, count = 0;
  for (const MatchedPose& pose : poses) {
    for (; next < trajectory.size() && trajectory[next].stamp <= pose.stamp; ++next)
      if (trajectory[next].stamp - trajectory[next - 1].stamp > max_step) ++count;
    counts.push_back(count);
  }
  return counts;
}

/// Relative pose error [Kuemmerle09; Sturm12] of every segment from a pose to the first pose that is at least 1 m of
/// true distance later. A segment across a hole of the ground truth has no known distance and is left out.
RelativeError relative_error(const std::vector<MatchedPose>& poses, const Trajectory& T_world_body) {
  const std::vector<std::size_t> holes = holes_before(poses, T_world_body);
  std::vector<double> traveled_m(poses.size(), 0.0);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    traveled_m[i] =
        traveled_m[i - 1] + (poses[i].T_world_truth.position() - poses[i - 1].T_world_truth.position()).norm();
  }
  RelativeError error;
  for (std::size_t begin = 0, end = 0; begin < poses.size(); ++begin) {
    while (end < poses.size() && traveled_m[end] - traveled_m[begin] < kSegment_m) ++end;
    if (end == poses.size()) break;
    if (holes[begin] != holes[end]) continue;
    const Pose2 truth = poses[begin].T_world_truth.inverse() * poses[end].T_world_truth;
    const Pose2 estimate = poses[begin].T_world_estimate.inverse() * poses[end].T_world_estimate;
    const Pose2 difference = truth.inverse() * estimate;
    error.translation_m.push_back(difference.position().norm());
    error.rotation_rad.push_back(difference.yaw);
  }
  return error;
}

/// Positions at the paired stamps, one per column.
struct PointPairs {
  Eigen::Matrix3Xd estimate;
  Eigen::Matrix3Xd reference;
};

/// Index of the stamp nearest to `stamp`, the earlier of two equally near ones.
std::size_t nearest_index(const Trajectory& trajectory, Time stamp) {
  const auto after = std::upper_bound(trajectory.begin(), trajectory.end(), stamp,
                                      [](Time t, const StampedPose& entry) { return t < entry.stamp; });
  if (after == trajectory.begin()) return 0;
  const auto before = after - 1;
  const bool take_after = after != trajectory.end() && after->stamp - stamp < stamp - before->stamp;
  return static_cast<std::size_t>((take_after ? after : before) - trajectory.begin());
}

PointPairs pair_by_stamp(const Trajectory& estimate, const Trajectory& reference, Time max_dt) {
  const bool estimate_is_shorter = estimate.size() < reference.size();
  const Trajectory& shorter = estimate_is_shorter ? estimate : reference;
  const Trajectory& longer = estimate_is_shorter ? reference : estimate;
  std::vector<std::pair<std::size_t, std::size_t>> indices;
  for (std::size_t i = 0; i < shorter.size() && !longer.empty(); ++i) {
    const std::size_t nearest = nearest_index(longer, shorter[i].stamp);
    if (std::chrono::abs(longer[nearest].stamp - shorter[i].stamp) <= max_dt) {
      indices.emplace_back(i, nearest);
    }
  }
  const auto count = static_cast<Eigen::Index>(indices.size());
  PointPairs pairs{Eigen::Matrix3Xd(3, count), Eigen::Matrix3Xd(3, count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto [shorter_index, longer_index] = indices[static_cast<std::size_t>(i)];
    (estimate_is_shorter ? pairs.estimate : pairs.reference).col(i) = shorter[shorter_index].pose.position;
    (estimate_is_shorter ? pairs.reference : pairs.estimate).col(i) = longer[longer_index].pose.position;
  }
  return pairs;
}

bool is_level(const Eigen::Matrix3Xd& points) {
  return points.row(2).maxCoeff() - points.row(2).minCoeff() <= kLevel_m;
}

/// Rigid fit [Umeyama91, eqs. 34 to 43] with the scale fixed at 1. Positions on a level line determine a planar motion.
Pose3 fit_rigid_motion(const PointPairs& pairs) {
  constexpr double kSingular = std::numeric_limits<double>::epsilon();
  const Eigen::Vector3d estimate_mean = pairs.estimate.rowwise().mean();
  const Eigen::Vector3d reference_mean = pairs.reference.rowwise().mean();
  const Eigen::Matrix3d covariance = (pairs.reference.colwise() - reference_mean) *
                                     (pairs.estimate.colwise() - estimate_mean).transpose() /
                                     static_cast<double>(pairs.estimate.cols());
  const auto motion = [&](const Eigen::Quaterniond& R) { return Pose3{reference_mean - R * estimate_mean, R}; };
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (svd.singularValues()[1] > kSingular) {
    Eigen::Vector3d sign = Eigen::Vector3d::Ones();
    if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0) sign.z() = -1.0;
    return motion(Eigen::Quaterniond(Eigen::Matrix3d(svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose())));
  }
  const double cosine = covariance(0, 0) + covariance(1, 1), sine = covariance(1, 0) - covariance(0, 1);
  if (std::hypot(cosine, sine) <= kSingular || !is_level(pairs.estimate) || !is_level(pairs.reference))
    throw InputError("trajectories: no unique alignment: positions are on a point or on a line that is not level");
  return motion(quaternion_from_yaw(std::atan2(sine, cosine)));
}

}  // namespace

Pose2 align_at_start(const Trajectory& T_map_body, const Trajectory& T_world_body) {
  const Time max_step = max_interpolated_step(T_world_body);
  for (const StampedPose& entry : T_map_body) {
    if (const auto truth = pose_outside_holes(T_world_body, entry.stamp, max_step)) {
      return to_pose2(*truth) * to_pose2(entry.pose).inverse();
    }
  }
  throw InputError("estimate and reference do not overlap in time");
}

std::vector<MatchedPose> pair_poses(const Trajectory& T_map_body, const Pose2& T_world_map,
                                    const Trajectory& T_world_body) {
  std::vector<MatchedPose> matches;
  matches.reserve(T_map_body.size());
  const Time max_step = max_interpolated_step(T_world_body);
  for (const StampedPose& entry : T_map_body) {
    if (const auto truth = pose_outside_holes(T_world_body, entry.stamp, max_step)) {
      matches.push_back({entry.stamp, T_world_map * to_pose2(entry.pose), to_pose2(*truth)});
    }
  }
  return matches;
}

TrajectoryError trajectory_error(const Trajectory& T_map_body, const Pose2& T_world_map,
                                 const Trajectory& T_world_body) {
  const std::vector<MatchedPose> poses = pair_poses(T_map_body, T_world_map, T_world_body);
  if (poses.empty()) throw InputError("estimate and reference do not overlap in time");
  std::vector<double> position_m, heading_rad;
  for (const MatchedPose& pose : poses) {
    position_m.push_back(pose.position_error_m());
    heading_rad.push_back(pose.heading_error_rad());
  }
  const RelativeError relative = relative_error(poses, T_world_body);
  return {.num_poses = poses.size(),
          .ate_rmse_m = root_mean_square(position_m),
          .ate_mean_m = mean(position_m),
          .ate_max_m = maximum(position_m),
          .heading_rmse_deg = kDegPerRad * root_mean_square(heading_rad),
          .rpe_trans_1m_m = root_mean_square(relative.translation_m),
          .rpe_rot_1m_deg = kDegPerRad * root_mean_square(relative.rotation_rad)};
}

double time_coverage(const Trajectory& estimate, const Trajectory& reference) {
  if (reference.empty()) return 0.0;
  const Time begin = reference.front().stamp, end = reference.back().stamp;
  Time covered{}, covered_until = begin;
  bool is_any_near = false;
  for (const StampedPose& pose : estimate) {
    if (pose.stamp + kCoveredWithin < begin || pose.stamp - kCoveredWithin > end) continue;
    is_any_near = true;
    const Time from = std::max(covered_until, pose.stamp - kCoveredWithin);
    const Time until = std::min(end, pose.stamp + kCoveredWithin);
    if (until <= from) continue;
    covered += until - from;
    covered_until = until;
  }
  if (begin == end) return is_any_near ? 1.0 : 0.0;
  return to_seconds(covered) / to_seconds(end - begin);
}

AlignedError aligned_error(const Trajectory& estimate, const Trajectory& reference, Time max_dt) {
  const PointPairs pairs = pair_by_stamp(estimate, reference, max_dt);
  if (pairs.estimate.cols() < 3) {
    throw InputError(fmt::format("estimate and reference: fewer than three stamps within {:g} ms of each other",
                                 1e3 * to_seconds(max_dt)));
  }
  AlignedError error{.num_pairs = static_cast<std::size_t>(pairs.estimate.cols()),
                     .T_reference_estimate = fit_rigid_motion(pairs)};
  std::vector<double> distance_m;
  for (Eigen::Index i = 0; i < pairs.estimate.cols(); ++i) {
    const Eigen::Vector3d p_estimate = pairs.estimate.col(i), p_reference = pairs.reference.col(i);
    distance_m.push_back((error.T_reference_estimate * p_estimate - p_reference).norm());
  }
  error.rmse_m = root_mean_square(distance_m);
  error.mean_m = mean(distance_m);
  error.max_m = maximum(distance_m);
  return error;
}

}  // namespace patrol::score
