#pragma once

#include <Eigen/Core>

#include <optional>
#include <vector>

#include "core/surface_return.h"

namespace patrol::score {

/// Of one beam of a real lidar; the beams err independently.
struct BeamNoise {
  double range_std_m = 0.015;
  double direction_std_rad = 0.0;
};

/// How well one scan can tell where it was taken: the Cramer-Rao bound of the pose from its ranges (A. Censi, "On achievable accuracy for
/// range-finder localization", ICRA 2007). No unbiased matcher of one scan is better, whatever its method; a filter that remembers
/// earlier scans and odometry may be.
struct Localizability {
  int num_returns = 0;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of x, y, yaw in world: 1/m^2, 1/(m rad), 1/rad^2
  /// Standard deviations with the heading unknown as well, along the direction that the scan tells least of, and across it; `kUnbounded_m`
  /// when it tells nothing.
  double weak_std_m = 0.0;
  double strong_std_m = 0.0;
  double weak_direction_rad = 0.0;  ///< in world, -pi/2 ... pi/2

  static constexpr double kUnbounded_m = 100.0;
  static constexpr double kDegenerate_m = 0.1;  ///< a scan that leaves more than this along some direction does not tell the pose

  bool is_degenerate() const { return weak_std_m > kDegenerate_m; }
};

Localizability localizability(const std::vector<SurfaceReturn>& scan, const BeamNoise& noise);

/// The truth about a pose, beside what the stack said of it.
struct LocalizabilitySample {
  Localizability truth;
  double claimed_std_m = 0.0;          ///< along the weakest direction of the stack's own covariance
  double claimed_direction_rad = 0.0;  ///< that direction, in world
  std::optional<double> trust;         ///< 0 lost ... 1 sure, if it says so
};

/// How well the stack knew where it could not know. Figures that need degenerate poses, or an order that is not there, are none without.
struct LocalizabilityScore {
  std::size_t num_poses = 0;
  double weak_std_median_m = 0.0;
  double weak_std_max_m = 0.0;
  double degenerate_share = 0.0;                      ///< of the poses
  std::optional<double> covariance_rank_correlation;  ///< Spearman's, of the claimed deviation with the true one
  std::optional<double> trust_rank_correlation;       ///< likewise of the trust: -1 is best
  std::optional<double> covariance_detection;         ///< chance that a degenerate pose was claimed weaker than one that is not (AUC); 0.5: no better than a coin
  std::optional<double> trust_detection;              ///< likewise by the trust
  std::optional<double> weak_direction_error_deg;     ///< mean, of the degenerate poses, 0 ... 90
};

LocalizabilityScore localizability_score(const std::vector<LocalizabilitySample>& samples);

}  // namespace patrol::score
