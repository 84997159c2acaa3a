#include "score/localizability.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/geometry/angles.h"
#include "core/geometry/principal_axes.h"
#include "score/statistics.h"

namespace patrol::score {
namespace {

double to_std_m(double information) {
  constexpr double kMinInformation = 1.0 / (Localizability::kUnbounded_m * Localizability::kUnbounded_m);
  return 1.0 / std::sqrt(std::max(information, kMinInformation));
}

/// Maps an angle to -pi/2 ... pi/2: a direction and its opposite are equivalent.
double wrap_half_turn(double angle_rad) { return std::remainder(angle_rad, std::numbers::pi); }

}  // namespace

Localizability localizability(const std::vector<BeamReturn>& scan, const BeamNoise& noise) {
  Localizability result{.num_returns = static_cast<int>(scan.size())};
  for (const BeamReturn& beam : scan) {
    // Plane n . (p + r d - q) = 0 through surface point q: derivatives of r by the position p and by the beam's angle.
    const double cosine = beam.normal.head<2>().dot(beam.direction);
    const Eigen::Vector2d perpendicular(-beam.direction.y(), beam.direction.x());
    const double d_range_by_yaw_m = -beam.range_m * beam.normal.head<2>().dot(perpendicular) / cosine;
    const Eigen::Vector3d jacobian(-beam.normal.x() / cosine, -beam.normal.y() / cosine, d_range_by_yaw_m);
    const double spread_m = d_range_by_yaw_m * noise.direction_std_rad;
    const double variance_m2 = noise.range_std_m * noise.range_std_m + spread_m * spread_m;
    result.information += jacobian * jacobian.transpose() / variance_m2;
  }
  Eigen::Matrix2d position = result.information.topLeftCorner<2, 2>();
  if (const double turn = result.information(2, 2); turn > 0.0) {
    position -= result.information.topRightCorner<2, 1>() * result.information.bottomLeftCorner<1, 2>() / turn;
  }
  const PrincipalAxes axes = principal_axes(position);
  result.max_std_m = to_std_m(axes.small);
  result.min_std_m = to_std_m(axes.large);
  result.max_std_direction_rad = axes.small_direction_rad();
  return result;
}

LocalizabilityScore localizability_score(const std::vector<LocalizabilitySample>& samples) {
  std::vector<double> truth, claimed, truth_with_confidence, negated_confidence, direction_errors_deg;
  std::vector<bool> is_degenerate, is_degenerate_with_confidence;
  for (const LocalizabilitySample& sample : samples) {
    truth.push_back(sample.truth.max_std_m);
    claimed.push_back(sample.reported_std_m);
    is_degenerate.push_back(sample.truth.is_degenerate());
    if (sample.confidence) {
      truth_with_confidence.push_back(sample.truth.max_std_m);
      negated_confidence.push_back(-*sample.confidence);
      is_degenerate_with_confidence.push_back(sample.truth.is_degenerate());
    }
    if (sample.truth.is_degenerate()) {
      const double error_rad =
          std::abs(wrap_half_turn(sample.reported_direction_rad - sample.truth.max_std_direction_rad));
      direction_errors_deg.push_back(to_deg(error_rad));
    }
  }
  LocalizabilityScore score{.num_poses = samples.size(),
                            .max_std_median_m = percentile(truth, 0.5),
                            .max_std_max_m = maximum(truth),
                            .degenerate_fraction = samples.empty() ? 0.0
                                                                   : static_cast<double>(direction_errors_deg.size()) /
                                                                         static_cast<double>(samples.size()),
                            .covariance_rank_correlation = rank_correlation(claimed, truth),
                            .confidence_rank_correlation = {},
                            .covariance_detection = roc_auc(claimed, is_degenerate),
                            .confidence_detection = roc_auc(negated_confidence, is_degenerate_with_confidence),
                            .max_std_direction_error_deg = {}};
  if (const auto correlation = rank_correlation(negated_confidence, truth_with_confidence))
    score.confidence_rank_correlation = -*correlation;
  if (!direction_errors_deg.empty()) score.max_std_direction_error_deg = mean(direction_errors_deg);
  return score;
}

}  // namespace patrol::score
