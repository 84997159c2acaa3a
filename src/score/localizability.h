#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/beam_return.h"

namespace patrol::score {

/// Noise of a single lidar beam. The errors of different beams are independent.
struct BeamNoise {
  double range_std_m = 0.015;
  double direction_std_rad = 0.0;
};

/// Cramer-Rao bound of the pose from the ranges of one scan [Censi07]. No unbiased matcher of a single scan has a
/// smaller covariance. A filter that also uses earlier scans and odometry may have one.
struct Localizability {
  int num_returns = 0;
  /// Fisher information of x, y, yaw in world: 1/m^2, 1/(m rad), 1/rad^2
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  /// Standard deviations of the position with unknown heading, along the least observable direction and across it.
  /// `kUnbounded_m` when the scan does not constrain the direction.
  double max_std_m = 0.0;
  double min_std_m = 0.0;
  double max_std_direction_rad = 0.0;  ///< least observable direction in world, -pi/2 ... pi/2

  static constexpr double kUnbounded_m = 100.0;
  static constexpr double kDegenerate_m = 0.1;  ///< standard deviation above which the pose counts as degenerate

  bool is_degenerate() const { return max_std_m > kDegenerate_m; }
};

/// Computes the bound from the returns of one scan. `scan` contains only beams that hit a surface.
Localizability localizability(const std::vector<BeamReturn>& scan, const BeamNoise& noise);

/// Bound on the pose with the covariance and the confidence that the stack reported for it.
struct LocalizabilitySample {
  Localizability truth;
  double reported_std_m = 0.0;          ///< standard deviation along the weakest direction of the stack's covariance
  double reported_direction_rad = 0.0;  ///< weakest direction of the stack's covariance, in world
  std::optional<double> confidence;     ///< confidence, 0 lost ... 1 certain; none when the stack does not report one
};

/// Agreement of the stack's reported uncertainty with the Cramer-Rao bound. Values that need degenerate poses, or lists
/// that vary, are none without them.
struct LocalizabilityScore {
  std::size_t num_poses = 0;
  double max_std_median_m = 0.0;
  double max_std_max_m = 0.0;
  double degenerate_fraction = 0.0;  ///< fraction of poses that are degenerate
  /// Spearman's correlation of the reported with the true standard deviation
  std::optional<double> covariance_rank_correlation;
  /// Spearman's correlation of the confidence with the true standard deviation; -1 is best
  std::optional<double> confidence_rank_correlation;
  /// probability that a degenerate pose has a larger reported standard deviation than a non-degenerate one (AUC); 0.5
  /// is chance level
  std::optional<double> covariance_detection;
  /// probability that a degenerate pose has a lower confidence than a non-degenerate one (AUC)
  std::optional<double> confidence_detection;
  /// mean error of the weakest direction over the degenerate poses, 0 ... 90
  std::optional<double> max_std_direction_error_deg;
};

/// Evaluates the samples of a run.
LocalizabilityScore localizability_score(const std::vector<LocalizabilitySample>& samples);

}  // namespace patrol::score
