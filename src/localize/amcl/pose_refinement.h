#pragma once

#include <Eigen/Core>

#include "core/frames.h"
#include "core/messages.h"
#include "localize/amcl/line_field.h"
#include "localize/amcl/pose_refinement_settings.h"
#include "slam/match_points.h"
#include "slam/pose_gaussian.h"

namespace patrol::localize {

struct RefinedPose {
  slam::PoseGaussian posterior;  ///< pose given the prior and the scan
  /// Information of the scan alone for x, y, yaw in map, tempered; zero in degenerate directions.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  int num_points = 0;         ///< number of matched scan points
  double inlier_ratio = 0.0;  ///< inlier ratio: fraction of these within twice the kernel of a surface
  bool is_matched = false;    ///< false: the posterior is the prior
};

/// Gaussian posterior of a prior and a scan matched to a known map. Gauss-Newton on the distances of the points to the
/// lines of the map, as in slam/scan_matcher.h, from `T_map_start`.
///
/// In a degenerate corridor all lines are parallel to it, but map noise rotates each by a few degrees. Hundreds of them
/// would constrain the position along the corridor to centimeters, at the same wrong position scan after scan. A line
/// therefore constrains the weaker direction only if it clearly faces it. In a featureless tunnel no line does, and
/// that direction keeps the prior (solution remapping [Zhang16]).
/// Deviation from [Zhang16]: the projection is applied per line, not per eigenvalue.
RefinedPose refine_pose(const LineField& lines, const LevelScan& scan, const slam::PoseGaussian& prior,
                        const Pose2& T_map_start, const PoseRefinementSettings& settings);

/// Proposal distribution given a particle and the scan match, both normally distributed. It is the improved proposal of
/// [Grisetti07], with one scan match for all particles near it. Along degenerate directions a particle is unchanged
/// except for its spread.
class ScanProposal {
 public:
  /// `spread`: covariance of a particle about its pose; x, y, yaw.
  ScanProposal(const RefinedPose& refined, const Eigen::Matrix3d& spread);

  /// Samples a pose; `unit` is a standard normal vector.
  Pose2 sample(const Pose2& particle, const Eigen::Vector3d& unit) const;

 private:
  Pose2 matched_;
  Eigen::Matrix3d gain_, root_;  ///< gain on the offset to the match; root of the covariance of the proposal
};

}  // namespace patrol::localize
