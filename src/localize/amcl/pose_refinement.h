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
  int max_points = 400;                 ///< of a scan that are laid on the map
  double point_spacing_m = 0.1;         ///< beams nearer together than this are averaged
  double point_std_m = 0.03;            ///< of a point's range, and of the map's cells
  double point_angle_std_rad = 0.0015;  ///< of its direction
  double kernel_m = 0.08;               ///< from here on a point counts as an outlier, gradually
  double likelihood_gain = 0.1;         ///< share of the points that err independently
  double min_facing = 0.15;             ///< a line that faces the weak direction by no more (a sine) says nothing about it
  double map_std_m = 0.01;              ///< of the map itself, which no number of scans averages away
  double map_std_rad = 0.001;
  int max_iterations = 8;
  double min_matched_share = 0.3;       ///< fewer points on surfaces are no match

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("max_points", self.max_points, between(10, 100000));
    visit("point_spacing_m", self.point_spacing_m, between(0.0, 5.0));
    visit("point_std_m", self.point_std_m, between(1e-4, 1.0));
    visit("point_angle_std_rad", self.point_angle_std_rad, between(0.0, 0.1));
    visit("kernel_m", self.kernel_m, between(1e-3, 10.0));
    visit("likelihood_gain", self.likelihood_gain, between(1e-4, 1.0));
    visit("min_facing", self.min_facing, between(0.0, 0.9));
    visit("map_std_m", self.map_std_m, between(0.0, 1.0));
    visit("map_std_rad", self.map_std_rad, between(0.0, 0.1));
    visit("max_iterations", self.max_iterations, between(1, 100));
    visit("min_matched_share", self.min_matched_share, between(0.0, 1.0));
  }
};

struct RefinedPose {
  slam::PoseGaussian posterior;  ///< of the pose, given the prior and the scan
  /// Of the scan alone, x, y, yaw in map, with the gain; zero in a direction in which the map says nothing.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  int num_points = 0;            ///< of the scan that were laid on the map
  double matched_share = 0.0;    ///< of these, on a surface: within twice the kernel
  bool is_matched = false;       ///< otherwise the posterior is the prior
};

/// The Gaussian posterior of a prior and a scan on the map: Gauss-Newton on the points' distances to the lines of the map,
/// as slam/scan_matcher.h does while the map grows, from `T_map_start`.
///
/// In a degenerate corridor every line is parallel to the way, but noise in the map turns each a few degrees, and hundreds
/// of them would tell the place along the way to centimetres: wrongly, and the same wrong place scan after scan. So a line
/// counts in the weaker direction only if it clearly faces it. What is left there is what the map knows, and in a
/// featureless tunnel that is nothing: the direction stays with the prior ("solution remapping", Zhang, Kaess, Singh, "On
/// degeneracy of optimization-based state estimation problems", ICRA 2016; there by eigenvalue, here line by line).
RefinedPose refine_pose(const LineField& lines, const LevelScan& scan, const slam::PoseGaussian& prior, const Pose2& T_map_start,
                        const PoseRefinementSettings& settings);

/// Draws poses from what a particle and the scan say together, both normally distributed: the improved proposal of Grisetti,
/// Stachniss, Burgard (IEEE T-RO 2007), with one scan match for all particles near it. Along a direction that the scan leaves
/// open a particle stays where it is.
class ScanProposal {
 public:
  /// `spread`: covariance of a particle about its pose; x, y, yaw.
  ScanProposal(const RefinedPose& refined, const Eigen::Matrix3d& spread);

  /// `unit` is standard normal.
  Pose2 draw(const Pose2& particle, const Eigen::Vector3d& unit) const;

 private:
  Pose2 matched_;
  Eigen::Matrix3d gain_, root_;  ///< of the way to the match, and of the posterior's covariance
};

}  // namespace patrol::localize
