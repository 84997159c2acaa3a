#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/settings.h"

namespace patrol::realism {

/// Return on a smooth surface, for the fit of noise and systematic errors.
struct HitSample {
  double residual_m = 0.0;       ///< recorded minus expected range
  double range_m = 0.0;          ///< expected
  double slope_m_per_rad = 0.0;  ///< change of the expected range with the azimuth
  double cosine = 1.0;           ///< cosine of the angle of incidence
  double darkness = 0.0;         ///< log(0.5 / reflectivity) / log(5): 0 on 50 %, 1 on 10 %
  std::size_t block = 0;         ///< group of scans, within which errors may be correlated
};

/// Parameters of the fit, in the order of `HitModel::values`. The last eight are logarithms inside of the fit.
enum HitParameter : std::size_t {
  kOffset_m,         ///< range error at range 0, normal incidence and 50 % reflectivity
  kScale,            ///< relative range error
  kIncidence_m,      ///< range error at grazing incidence relative to normal incidence
  kReflectivity_m,   ///< range error on 10 % reflectivity relative to 50 %
  kNoise_m,          ///< standard deviation of the range
  kAngleNoise_rad,   ///< standard deviation of the azimuth
  kFalseRate_per_m,  ///< rate of false returns
  kOutlierRatio,     ///< fraction of returns that the model does not explain (errors of the site), uniform in range
  kWideProbability,  ///< fraction of returns with additional noise
  kWideNoise_m,      ///< standard deviation of the additional noise
  kNumHitParameters
};
using HitVector = std::array<double, kNumHitParameters>;

/// Likelihood of residuals: normal with variance noise^2 + (slope angle_noise)^2 about the systematic error and the
/// effect of the angle noise on a plane of second order, integrated over the quantization step. It is mixed with normal
/// residuals of the additional noise, false returns (uniform before the surface) and outliers (uniform up to the
/// maximum range).
struct HitModel {
  double range_step_m = 0.0;
  double range_max_m = 30.0;
  double range_min_m = 0.0;                        ///< false returns before it are not in the samples
  std::array<bool, kNumHitParameters> is_fixed{};  ///< parameters that are zero instead of fitted
};

/// Maximum of the likelihood with what the intervals need.
struct HitFit {
  HitVector values{};       ///< natural units
  HitVector low{}, high{};  ///< 95 % profile intervals
  std::array<bool, kNumHitParameters> is_free{};
  double log_likelihood = 0.0;
  std::size_t num_samples = 0;
  double range_spread_m = 0.0;       ///< standard deviation of the ranges of the samples
  double incidence_spread = 0.0;     ///< standard deviation of 1 - cosine
  double darkness_spread = 0.0;      ///< standard deviation of the darkness
  double max_slope_m_per_rad = 0.0;  ///< 95 % of the slopes are smaller
};

/// Fits the parameters by maximum likelihood [Berndt74] with profile intervals. The threshold of the profiles is
/// enlarged by the ratio of the block-clustered to the model's variance where this exceeds 1. Systematic errors whose
/// regressor does not vary are fixed at 0, and so is additional noise that raises the log-likelihood by less than 6.
HitFit fit_hits(const std::vector<HitSample>& samples, const HitModel& model, bool with_intervals = true);

}  // namespace patrol::realism
