#pragma once

#include <Eigen/Core>

#include "core/frames.h"
#include "core/messages.h"
#include "core/settings.h"
#include "localize/amcl/line_field.h"
#include "slam/match_points.h"
#include "slam/pose_gaussian.h"

namespace patrol::localize {

struct PoseRefinementSettings {
  int max_points = 400;                 ///< maximum number of scan points matched to the map
  double point_spacing_m = 0.1;         ///< consecutive beams that end within this distance are averaged
  double point_std_m = 0.03;            ///< standard deviation of the range of a point and of the map cells
  double point_angle_std_rad = 0.0015;  ///< standard deviation of the direction of a point
  double kernel_m = 0.08;  ///< scale of the Cauchy kernel; residuals beyond it are down-weighted as outliers
  double likelihood_tempering = 0.1;         ///< tempering factor: fraction of the points with independent errors
  /// A line constrains the weak direction only if the sine of its angle to that direction is larger.
  double min_incidence_sine = 0.15;
  double map_std_m = 0.01;              ///< standard deviation of the map itself, which is not reduced by averaging
  double map_std_rad = 0.001;
  int max_iterations = 8;
  double min_inlier_ratio = 0.3;       ///< matches with a smaller inlier ratio are rejected

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("max_points", self.max_points, between(10, 100000));
    visit("point_spacing_m", self.point_spacing_m, between(0.0, 5.0));
    visit("point_std_m", self.point_std_m, between(1e-4, 1.0));
    visit("point_angle_std_rad", self.point_angle_std_rad, between(0.0, 0.1));
    visit("kernel_m", self.kernel_m, between(1e-3, 10.0));
    visit("likelihood_tempering", self.likelihood_tempering, between(1e-4, 1.0));
    visit("min_incidence_sine", self.min_incidence_sine, between(0.0, 0.9));
    visit("map_std_m", self.map_std_m, between(0.0, 1.0));
    visit("map_std_rad", self.map_std_rad, between(0.0, 0.1));
    visit("max_iterations", self.max_iterations, between(1, 100));
    visit("min_inlier_ratio", self.min_inlier_ratio, between(0.0, 1.0));
  }
};

struct RefinedPose {
  slam::PoseGaussian posterior;  ///< pose given the prior and the scan
  /// Information of the scan alone for x, y, yaw in map, tempered; zero in degenerate directions.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  int num_points = 0;            ///< number of matched scan points
  double inlier_ratio = 0.0;    ///< inlier ratio: fraction of these within twice the kernel of a surface
  bool is_matched = false;       ///< false: the posterior is the prior
};

/// Gaussian posterior of a prior and a scan matched to a known map. Gauss-Newton on the distances of the points to the
/// lines of the map, as in slam/scan_matcher.h, from `T_map_start`.
///
/// In a degenerate corridor all lines are parallel to it, but map noise rotates each by a few degrees. Hundreds of them
/// would constrain the position along the corridor to centimeters, at the same wrong position scan after scan. A line
/// therefore constrains the weaker direction only if it clearly faces it. In a featureless tunnel no line does, and
/// that direction keeps the prior (solution remapping [Zhang16]).
/// Deviation from [Zhang16]: the projection is applied per line, not per eigenvalue.
RefinedPose refine_pose(const LineField& lines, const LevelScan& scan, const slam::PoseGaussian& prior, const Pose2& T_map_start,
                        const PoseRefinementSettings& settings);

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
