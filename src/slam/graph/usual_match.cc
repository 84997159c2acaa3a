#include "slam/graph/usual_match.h"

#include <algorithm>
#include <cmath>

namespace patrol::slam {
namespace {

/// A scan matches as usual unless fewer points match by this many standard deviations, or the inlier ratio is smaller.
/// The fraction of matched points varies by kStd from place to place.
constexpr double kDeviations = 2.0, kStd = 0.03, kMinInlierRatio = 0.9;
/// Rate of the running means, per scan.
constexpr double kRate = 0.05;
/// Log likelihood of a point in an unknown cell, at least; relative to a point on a surface.
constexpr double kMinUnknown = -3.0;
/// A scan whose mean loss is larger than usual by this factor does not match as usual.
constexpr double kUnusualLoss = 1.5;

double mean_loss(const std::vector<double>& log_likelihoods) {
  double sum = 0.0;
  int count = 0;
  for (const double value : log_likelihoods) {
    if (std::isnan(value)) continue;
    sum -= value;
    ++count;
  }
  return count > 0 ? sum / count : 0.0;
}

double matched_ratio(const MatchResult& match, const std::vector<double>& log_likelihoods) {
  return match.num_matched / static_cast<double>(log_likelihoods.size());
}

}  // namespace

// Limits a loss, so that one bad match does not hide the next.
void UsualMatch::update(const MatchResult& match, const std::vector<double>& log_likelihoods) {
  loss_ += kRate * (std::min(mean_loss(log_likelihoods), 2.0 * loss_) - loss_);
  matched_ratio_ += kRate * (matched_ratio(match, log_likelihoods) - matched_ratio_);
}

bool UsualMatch::has_usual_points(const MatchResult& match, const std::vector<double>& log_likelihoods) const {
  const auto num_points = static_cast<double>(log_likelihoods.size());
  const double deviation = std::sqrt(matched_ratio_ * (1.0 - matched_ratio_) / num_points + kStd * kStd);
  return match.inlier_ratio >= kMinInlierRatio &&
         matched_ratio(match, log_likelihoods) >= matched_ratio_ - kDeviations * deviation;
}

bool UsualMatch::has_usual_loss(const std::vector<double>& log_likelihoods) const {
  return !(mean_loss(log_likelihoods) > kUnusualLoss * loss_);
}

double UsualMatch::unknown_log_likelihood() const {
  const double matched = std::clamp(matched_ratio_, 0.05, 0.95);
  return std::clamp(std::log((1.0 - matched) / matched), kMinUnknown, 0.0);
}

}  // namespace patrol::slam
