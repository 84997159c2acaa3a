#include "score/localizability.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/angles.h"
#include "core/symmetric_axes.h"
#include "score/statistics.h"

namespace patrol::score {
namespace {

double std_of(double information) {
  constexpr double kLeast = 1.0 / (Localizability::kUnbounded_m * Localizability::kUnbounded_m);
  return 1.0 / std::sqrt(std::max(information, kLeast));
}

/// Maps an angle to -pi/2 ... pi/2: a direction and its opposite are equivalent.
double folded(double angle_rad) { return std::remainder(angle_rad, std::numbers::pi); }

}  // namespace

Localizability localizability(const std::vector<SurfaceReturn>& scan, const BeamNoise& noise) {
  Localizability result{.num_returns = static_cast<int>(scan.size())};
  for (const SurfaceReturn& beam : scan) {
    // Plane n . (p + r d - q) = 0 through surface point q: derivatives of r by the position p and by the beam's angle.
    const double cosine = beam.normal.head<2>().dot(beam.direction);
    const Eigen::Vector2d turned(-beam.direction.y(), beam.direction.x());
    const double per_rad_m = -beam.range_m * beam.normal.head<2>().dot(turned) / cosine;
    const Eigen::Vector3d jacobian(-beam.normal.x() / cosine, -beam.normal.y() / cosine, per_rad_m);
    const double spread_m = per_rad_m * noise.direction_std_rad;
    const double variance_m2 = noise.range_std_m * noise.range_std_m + spread_m * spread_m;
    result.information += jacobian * jacobian.transpose() / variance_m2;
  }
  Eigen::Matrix2d position = result.information.topLeftCorner<2, 2>();
  if (const double turn = result.information(2, 2); turn > 0.0) {
    position -= result.information.topRightCorner<2, 1>() * result.information.bottomLeftCorner<1, 2>() / turn;
  }
  const SymmetricAxes axes = symmetric_axes(position);
  result.weak_std_m = std_of(axes.small);
  result.strong_std_m = std_of(axes.large);
  result.weak_direction_rad = axes.small_direction_rad();
  return result;
}

LocalizabilityScore localizability_score(const std::vector<LocalizabilitySample>& samples) {
  std::vector<double> truth, claimed, trusted_truth, doubt, direction_errors_deg;
  std::vector<bool> is_degenerate, is_trusted_degenerate;
  for (const LocalizabilitySample& sample : samples) {
    truth.push_back(sample.truth.weak_std_m);
    claimed.push_back(sample.claimed_std_m);
    is_degenerate.push_back(sample.truth.is_degenerate());
    if (sample.trust) {
      trusted_truth.push_back(sample.truth.weak_std_m);
      doubt.push_back(-*sample.trust);
      is_trusted_degenerate.push_back(sample.truth.is_degenerate());
    }
    if (sample.truth.is_degenerate()) {
      const double error_rad = std::abs(folded(sample.claimed_direction_rad - sample.truth.weak_direction_rad));
      direction_errors_deg.push_back(to_deg(error_rad));
    }
  }
  LocalizabilityScore score{.num_poses = samples.size(),
                            .weak_std_median_m = percentile(truth, 0.5),
                            .weak_std_max_m = maximum(truth),
                            .degenerate_share = samples.empty() ? 0.0 : static_cast<double>(direction_errors_deg.size()) / static_cast<double>(samples.size()),
                            .covariance_rank_correlation = rank_correlation(claimed, truth),
                            .trust_rank_correlation = {},
                            .covariance_detection = chance_of_order(claimed, is_degenerate),
                            .trust_detection = chance_of_order(doubt, is_trusted_degenerate),
                            .weak_direction_error_deg = {}};
  if (const auto by_doubt = rank_correlation(doubt, trusted_truth)) score.trust_rank_correlation = -*by_doubt;
  if (!direction_errors_deg.empty()) score.weak_direction_error_deg = mean(direction_errors_deg);
  return score;
}

}  // namespace patrol::score
