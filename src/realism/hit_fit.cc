#include "realism/hit_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <Eigen/Dense>

#include "core/geometry/angles.h"

namespace patrol::realism {
namespace {

constexpr std::size_t kNum = kNumHitParameters;
using HitColumn = Eigen::Matrix<double, kNum, 1>;
using HitMatrix = Eigen::Matrix<double, kNum, kNum>;

/// Lower bounds in the fit; below them a parameter is zero.
constexpr HitVector kFloor = {-10.0, -1.0, -10.0, -10.0, 1e-5, 2e-6, 1e-7, 1e-7, 1e-7, 1e-5};
constexpr HitVector kCeiling = {10.0, 1.0, 10.0, 10.0, 2.0, 0.1, 1.0, 0.9, 0.9, 1.0};

bool is_logarithmic(std::size_t parameter) { return parameter >= kNoise_m; }

double to_fit(std::size_t parameter, double value) {
  return is_logarithmic(parameter) ? std::log(std::max(value, kFloor[parameter])) : value;
}
double from_fit(std::size_t parameter, double value) { return is_logarithmic(parameter) ? std::exp(value) : value; }

double normal_density(double z) { return std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi); }

/// Probability of a standard normal number in (low, high), accurate in both tails.
double normal_between(double low, double high) {
  if (low > 0.0) return normal_between(-high, -low);
  return 0.5 * (std::erfc(-high / std::numbers::sqrt2) - std::erfc(-low / std::numbers::sqrt2));
}

/// Returns whether a parameter is at a bound and its gradient points beyond. It is left out of a step: the step of a
/// parameter without information would be unlimited, and would carry those of the others along.
bool is_pushed_out(std::size_t parameter, double value, double gradient) {
  return (value <= kFloor[parameter] * (is_logarithmic(parameter) ? 1.001 : 1.0) && gradient < 0.0) ||
         (value >= kCeiling[parameter] && gradient > 0.0);
}

/// Density of a residual about a mean, with its derivatives.
struct CoreDensity {
  double value, by_mean, by_std;
};

CoreDensity core_density(double deviation_m, double std_m, double step_m) {
  if (step_m < 0.05 * std_m) {
    const double z = deviation_m / std_m, density = normal_density(z) / std_m;
    return {density, density * z / std_m, density * (z * z - 1.0) / std_m};
  }
  const double high = (deviation_m + 0.5 * step_m) / std_m, low = (deviation_m - 0.5 * step_m) / std_m;
  const double at_high = normal_density(high), at_low = normal_density(low);
  return {normal_between(low, high) / step_m, (at_low - at_high) / (std_m * step_m),
          (low * at_low - high * at_high) / (std_m * step_m)};
}

/// Density of a residual without false returns and outliers, with its derivatives in the coordinates of the fit.
struct MixedDensity {
  double value = 0.0, by_mean = 0.0, by_noise = 0.0, by_angle_noise = 0.0, by_wide_probability = 0.0,
         by_wide_noise = 0.0;
};

MixedDensity mixed_density(double deviation_m, double from_angle_m, double step_m, const HitVector& p) {
  MixedDensity sum;
  const auto add = [&](double weight, double std_m) {
    const CoreDensity core = core_density(deviation_m, std_m, step_m);
    const double by_std = weight * core.by_std / std_m;
    sum.value += weight * core.value;
    sum.by_mean += weight * core.by_mean;
    sum.by_noise += by_std * p[kNoise_m] * p[kNoise_m];
    sum.by_angle_noise += by_std * from_angle_m * from_angle_m;
    return std::pair(core.value, by_std);
  };
  const double wide = p[kWideProbability], std_m = std::hypot(p[kNoise_m], from_angle_m);
  const double narrow_value = add(1.0 - wide, std_m).first;
  if (wide <= kFloor[kWideProbability]) return sum;
  const auto [wide_value, by_wide_std] = add(wide, std::hypot(std_m, p[kWideNoise_m]));
  sum.by_wide_probability = wide * (wide_value - narrow_value);
  sum.by_wide_noise = by_wide_std * p[kWideNoise_m] * p[kWideNoise_m];
  return sum;
}

/// Log-likelihood of one sample; `score` is its gradient in the coordinates of the fit.
double sample_log_likelihood(const HitSample& sample, const HitModel& model, const HitVector& p, HitColumn* score) {
  // A plane at the azimuth a has the second derivative r (1 + 2 tan^2).
  const double curvature_m = sample.range_m + 2.0 * sample.slope_m_per_rad * sample.slope_m_per_rad / sample.range_m;
  const double from_curvature_m = 0.5 * curvature_m * p[kAngleNoise_rad] * p[kAngleNoise_rad];
  const double mean_m = p[kOffset_m] + p[kScale] * sample.range_m + p[kIncidence_m] * (1.0 - sample.cosine) +
                        p[kReflectivity_m] * sample.darkness + from_curvature_m;
  const double from_angle_m = sample.slope_m_per_rad * p[kAngleNoise_rad];
  const MixedDensity core = mixed_density(sample.residual_m - mean_m, from_angle_m, model.range_step_m, p);
  const double through = std::exp(-p[kFalseRate_per_m] * sample.range_m);
  const double observed = 1.0 - (1.0 - through) * std::min(1.0, model.range_min_m / sample.range_m);
  const double is_before = sample.residual_m < 0.0 ? 1.0 : 0.0;
  const double inside = 1.0 - p[kOutlierRatio];
  const double rest = inside * (1.0 - through) / sample.range_m * is_before + p[kOutlierRatio] / model.range_max_m;
  const double density = std::max(inside * through * core.value + rest, 1e-300);
  if (score != nullptr) {
    const double of_core = inside * through / density, by_mean = of_core * core.by_mean;
    (*score)[kOffset_m] = by_mean;
    (*score)[kScale] = by_mean * sample.range_m;
    (*score)[kIncidence_m] = by_mean * (1.0 - sample.cosine);
    (*score)[kReflectivity_m] = by_mean * sample.darkness;
    (*score)[kNoise_m] = of_core * core.by_noise;
    (*score)[kAngleNoise_rad] = of_core * core.by_angle_noise + 2.0 * by_mean * from_curvature_m;
    (*score)[kWideProbability] = of_core * core.by_wide_probability;
    (*score)[kWideNoise_m] = of_core * core.by_wide_noise;
    const double by_rate = inside * through * (is_before - sample.range_m * core.value);
    (*score)[kFalseRate_per_m] = p[kFalseRate_per_m] * (by_rate / density + through * model.range_min_m / observed);
    const double by_outliers =
        1.0 / model.range_max_m - through * core.value - (1.0 - through) / sample.range_m * is_before;
    (*score)[kOutlierRatio] = p[kOutlierRatio] * by_outliers / density;
  }
  return std::log(density / observed);
}

struct HitSums {
  double log_likelihood = 0.0;
  HitColumn gradient = HitColumn::Zero();
  HitMatrix information = HitMatrix::Zero();  ///< sum of the outer products of the scores
};

using FreeMask = std::array<bool, kNum>;

class HitLikelihood {
 public:
  HitLikelihood(const std::vector<HitSample>& samples, const HitModel& model) : samples_(samples), model_(model) {}

  HitSums sums(const HitVector& p) const {
    HitSums sums;
    HitColumn score;
    for (const HitSample& sample : samples_) {
      sums.log_likelihood += sample_log_likelihood(sample, model_, p, &score);
      sums.gradient += score;
      sums.information.noalias() += score * score.transpose();
    }
    return sums;
  }

  /// Maximizes over the free parameters from `p`, until a step gains less than `min_gain`; returns the log-likelihood.
  double maximize(HitVector& p, const FreeMask& is_free, int max_iterations, double min_gain = 1e-3) const {
    double damping = 1e-3;
    HitSums at = sums(p);
    for (int iteration = 0; iteration < max_iterations; ++iteration) {
      HitMatrix system = at.information;
      HitColumn gradient = at.gradient;
      for (std::size_t j = 0; j < kNum; ++j) {
        const auto k = static_cast<Eigen::Index>(j);
        if (is_free[j] && !is_pushed_out(j, p[j], gradient[k])) {
          system(k, k) += damping * system(k, k) + 1e-9;
          continue;
        }
        system.row(k).setZero(), system.col(k).setZero();
        system(k, k) = 1.0, gradient[k] = 0.0;
      }
      const HitColumn step = system.ldlt().solve(gradient);
      HitVector next = p;
      for (std::size_t j = 0; j < kNum; ++j) {
        if (!is_free[j]) continue;
        const double bounded = is_logarithmic(j) ? std::clamp(step[static_cast<Eigen::Index>(j)], -1.5, 1.5)
                                                 : step[static_cast<Eigen::Index>(j)];
        next[j] = std::clamp(from_fit(j, to_fit(j, p[j]) + bounded), kFloor[j], kCeiling[j]);
      }
      HitSums there = sums(next);
      if (!(there.log_likelihood > at.log_likelihood)) {
        if (at.gradient.dot(step) < 1e-3 || damping > 1e6) break;
        damping = std::max(1e-3, 10.0 * damping);
        continue;
      }
      const double gain = there.log_likelihood - at.log_likelihood;
      p = next;
      damping = std::max(1e-9, 0.1 * damping);
      at = there;
      if (gain < min_gain) break;
    }
    return at.log_likelihood;
  }

  /// Ratio of the variance by blocks of scans to that of the model, [parameter], at least 1.
  HitVector inflation(const HitVector& p, const FreeMask& is_free) const {
    std::size_t num_blocks = 0;
    for (const HitSample& sample : samples_) num_blocks = std::max(num_blocks, sample.block + 1);
    std::vector<HitColumn> blocks(num_blocks, HitColumn::Zero());
    HitMatrix information = HitMatrix::Zero();
    HitColumn score;
    for (const HitSample& sample : samples_) {
      sample_log_likelihood(sample, model_, p, &score);
      for (std::size_t j = 0; j < kNum; ++j) {
        if (!is_free[j] || p[j] <= 1.01 * kFloor[j]) score[static_cast<Eigen::Index>(j)] = 0.0;
      }
      blocks[sample.block] += score;
      information.noalias() += score * score.transpose();
    }
    HitMatrix by_blocks = HitMatrix::Zero();
    for (const HitColumn& block : blocks) by_blocks.noalias() += block * block.transpose();
    for (Eigen::Index k = 0; k < information.rows(); ++k) information(k, k) += 1e-9;
    const HitMatrix covariance = information.inverse();
    const HitMatrix clustered = covariance * by_blocks * covariance;
    HitVector ratio;
    for (std::size_t j = 0; j < kNum; ++j) {
      const auto k = static_cast<Eigen::Index>(j);
      ratio[j] = num_blocks < 5 ? 1.0 : std::max(1.0, clustered(k, k) / covariance(k, k));
      if (!std::isfinite(ratio[j])) ratio[j] = 1.0;
      std_[j] = std::sqrt(std::max(0.0, covariance(k, k) * ratio[j]));
    }
    return ratio;
  }
  /// Standard deviations in the coordinates of the fit, by the last `inflation`.
  const HitVector& standard_deviations() const { return std_; }

  /// Returns the end of the profile interval on one side (-1 or 1), in natural units: the loss of log-likelihood there
  /// is `threshold`. The root of the loss is nearly linear in the distance, so that few steps suffice.
  double profile_end(const HitVector& best, double best_value, const FreeMask& is_free, std::size_t j, double side,
                     double threshold) const {
    FreeMask others = is_free;
    others[j] = false;
    HitVector p = best;
    const auto root_of_loss = [&](double at) {
      p[j] = std::clamp(from_fit(j, at), kFloor[j], kCeiling[j]);
      return std::sqrt(std::max(0.0, best_value - maximize(p, others, 30, 0.01)));
    };
    const double wanted = std::sqrt(threshold), start = to_fit(j, best[j]);
    double inside = start, root_inside = 0.0, outside = start, root_outside = 0.0;
    double step = std::clamp(1.5 * wanted * std_[j], 1e-7, is_logarithmic(j) ? 1.0 : 0.5);
    for (int k = 0; k < 40 && root_outside <= wanted; ++k) {
      inside = outside, root_inside = root_outside;
      outside += side * step;
      root_outside = root_of_loss(outside);
      const bool is_at_floor = p[j] <= kFloor[j];
      if (root_outside <= wanted && (is_at_floor || p[j] >= kCeiling[j]))
        return is_at_floor && is_logarithmic(j) ? 0.0 : p[j];
      step *= 1.5;
    }
    for (int k = 0; k < 3; ++k) {
      const double fraction = std::clamp((wanted - root_inside) / (root_outside - root_inside), 0.05, 0.95);
      const double at = inside + fraction * (outside - inside), root = root_of_loss(at);
      if (root > wanted) outside = at, root_outside = root;
      else inside = at, root_inside = root;
    }
    const double fraction = std::clamp((wanted - root_inside) / (root_outside - root_inside), 0.0, 1.0);
    return from_fit(j, inside + fraction * (outside - inside));
  }

 private:
  const std::vector<HitSample>& samples_;
  HitModel model_;
  mutable HitVector std_{};
};

template <typename Value>
double spread_of(const std::vector<HitSample>& samples, Value value) {
  double sum = 0.0, squares = 0.0;
  for (const HitSample& sample : samples) sum += value(sample), squares += value(sample) * value(sample);
  const double n = static_cast<double>(samples.size()), mean = sum / n;
  return std::sqrt(std::max(0.0, squares / n - mean * mean));
}

/// Median and robust standard deviation of the residuals, to start from.
std::pair<double, double> robust_start(const std::vector<HitSample>& samples) {
  std::vector<double> values;
  for (const HitSample& sample : samples) values.push_back(sample.residual_m);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  const double median = *middle;
  for (double& value : values) value = std::abs(value - median);
  std::nth_element(values.begin(), middle, values.end());
  return {median, std::max(1e-4, 1.4826 * *middle)};
}

/// Adds the additional noise to a fit without it if the log-likelihood rises enough.
void add_wide_noise(const HitLikelihood& likelihood, HitFit& fit) {
  constexpr double kMinGain = 6.0;
  FreeMask is_free = fit.is_free;
  is_free[kWideProbability] = is_free[kWideNoise_m] = true;
  HitVector p = fit.values;
  p[kWideNoise_m] = 2.0 * p[kNoise_m];
  p[kNoise_m] *= 0.7;
  p[kWideProbability] = 0.2;
  const double value = likelihood.maximize(p, is_free, 200, 1e-6);
  if (value < fit.log_likelihood + kMinGain) return;
  fit.log_likelihood = value;
  fit.values = p;
  fit.is_free = is_free;
}

}  // namespace

HitFit fit_hits(const std::vector<HitSample>& samples, const HitModel& model, bool with_intervals) {
  constexpr double kThreshold = 1.9207;  // half of the 95 % quantile of chi-squared with one degree of freedom
  HitFit fit{.num_samples = samples.size()};
  if (samples.size() < 100) return fit;
  fit.range_spread_m = spread_of(samples, [](const HitSample& s) { return s.range_m; });
  fit.incidence_spread = spread_of(samples, [](const HitSample& s) { return s.cosine; });
  fit.darkness_spread = spread_of(samples, [](const HitSample& s) { return s.darkness; });
  std::vector<double> slopes;
  for (const HitSample& sample : samples) slopes.push_back(std::abs(sample.slope_m_per_rad));
  const auto at_95 = slopes.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(slopes.size() - 1));
  std::nth_element(slopes.begin(), at_95, slopes.end());
  fit.max_slope_m_per_rad = *at_95;

  fit.is_free.fill(true);
  fit.is_free[kScale] = fit.range_spread_m > 0.05;
  fit.is_free[kIncidence_m] = fit.incidence_spread > 0.01;
  fit.is_free[kReflectivity_m] = fit.darkness_spread > 0.05;
  fit.is_free[kAngleNoise_rad] = fit.max_slope_m_per_rad > 0.05;
  fit.is_free[kWideProbability] = fit.is_free[kWideNoise_m] = false;
  for (std::size_t j = 0; j < kNum; ++j) fit.is_free[j] = fit.is_free[j] && !model.is_fixed[j];
  const HitLikelihood likelihood(samples, model);
  const auto [median_m, spread_m] = robust_start(samples);
  fit.log_likelihood = -std::numeric_limits<double>::infinity();
  for (const double angle_deg : {0.01, 0.15}) {
    HitVector p = {median_m, 0.0, 0.0, 0.0, 0.8 * spread_m, angle_deg * kDegree, 1e-3, 1e-3, 0.0, 0.0};
    for (std::size_t j = 0; j < kNum; ++j) {
      if (!fit.is_free[j]) p[j] = is_logarithmic(j) ? kFloor[j] : 0.0;
    }
    const double value = likelihood.maximize(p, fit.is_free, 200);
    if (value <= fit.log_likelihood) continue;
    fit.log_likelihood = value;
    fit.values = p;
  }
  if (!model.is_fixed[kWideProbability]) add_wide_noise(likelihood, fit);
  if (!with_intervals) return fit;
  const HitVector ratio = likelihood.inflation(fit.values, fit.is_free);
  for (std::size_t j = 0; j < kNum; ++j) {
    if (!fit.is_free[j]) continue;
    fit.low[j] = likelihood.profile_end(fit.values, fit.log_likelihood, fit.is_free, j, -1.0, kThreshold * ratio[j]);
    fit.high[j] = likelihood.profile_end(fit.values, fit.log_likelihood, fit.is_free, j, 1.0, kThreshold * ratio[j]);
  }
  return fit;
}

}  // namespace patrol::realism
