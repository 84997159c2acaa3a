#include "realism/return_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace patrol::realism {
namespace {

constexpr double kBlurs = 5.0;  ///< distance from the limit in standard deviations beyond which a beam is decided

double log_binomial(double count, double total) {
  if (total <= 0.0 || count <= 0.0 || count >= total) return 0.0;
  return count * std::log(count / total) + (total - count) * std::log1p(-count / total);
}

/// Largest probability of a return beyond a limit: it is none if most beams return there.
constexpr double kMaxReturnsBeyond = 0.5;

/// Log-likelihood of the returns beyond a limit.
double log_beyond(double count, double total) {
  if (count <= kMaxReturnsBeyond * total) return log_binomial(count, total);
  return count * std::log(kMaxReturnsBeyond) + (total - count) * std::log1p(-kMaxReturnsBeyond);
}

/// Likelihood of a limit over samples in the order of their values.
class LimitLikelihood {
 public:
  explicit LimitLikelihood(std::vector<ReturnSample> samples) : samples_(std::move(samples)) {
    std::ranges::sort(samples_, {}, &ReturnSample::value);
    num_returns_.push_back(0.0);
    for (const ReturnSample& sample : samples_) {
      num_returns_.push_back(num_returns_.back() + (sample.is_return ? 1.0 : 0.0));
      max_blur_ = std::max(max_blur_, sample.blur);
    }
  }

  const std::vector<ReturnSample>& samples() const { return samples_; }
  double max_blur() const { return max_blur_; }

  double operator()(double limit) const {
    const std::size_t begin = index_of(limit - kBlurs * max_blur_), end = index_of(limit + kBlurs * max_blur_);
    const double below = static_cast<double>(begin), returns_below = num_returns_[begin];
    const double beyond = static_cast<double>(samples_.size() - end),
                 returns_beyond = num_returns_.back() - num_returns_[end];
    // Rates of the decided beams, with half a beam more so that no beam is impossible.
    const double dropout = (below - returns_below + 0.5) / (below + 1.0);
    const double outliers = std::min(kMaxReturnsBeyond, (returns_beyond + 0.5) / (beyond + 1.0));
    double sum = log_binomial(returns_below, below) + log_beyond(returns_beyond, beyond);
    for (std::size_t i = begin; i < end; ++i) {
      const double inside =
          samples_[i].blur > 0.0
              ? 0.5 * std::erfc((samples_[i].value - limit) / (samples_[i].blur * std::numbers::sqrt2))
              : (samples_[i].value < limit ? 1.0 : 0.0);
      const double probability = inside * (1.0 - dropout) + (1.0 - inside) * outliers;
      sum += std::log(std::max(1e-12, samples_[i].is_return ? probability : 1.0 - probability));
    }
    return sum;
  }

 private:
  std::size_t index_of(double value) const {
    return static_cast<std::size_t>(std::ranges::lower_bound(samples_, value, {}, &ReturnSample::value) -
                                    samples_.begin());
  }

  std::vector<ReturnSample> samples_;
  std::vector<double> num_returns_;
  double max_blur_ = 0.0;
};

}  // namespace

LimitFit fit_limit(std::vector<ReturnSample> samples, double end) {
  constexpr double kThreshold = 3.0;  // half of the 95 % quantile of chi-squared with two degrees of freedom
  constexpr int kCoarse = 400, kFine = 400;
  LimitFit fit{.high = end};
  if (samples.empty()) return fit;
  const LimitLikelihood likelihood(std::move(samples));
  const double first = likelihood.samples().front().value;
  const double last = likelihood.samples().back().value + (kBlurs + 1.0) * std::max(likelihood.max_blur(), 1e-6);
  const double coarse = (last - first) / kCoarse;
  const double none = likelihood(last);
  double best = last, best_value = none;
  const auto search = [&](double from, double step, int count) {
    for (int k = 0; k <= count; ++k) {
      const double at = from + step * k, value = likelihood(at);
      if (value > best_value) best_value = value, best = at;
    }
  };
  search(first, coarse, kCoarse);
  search(best - coarse, 2.0 * coarse / kFine, kFine);
  fit.value = best;
  fit.log_likelihood_gain = best_value - none;
  const double fine = 2.0 * coarse / kFine;
  fit.low = first, fit.high = last;
  // From the outside inward: the likelihood of a change point has several maxima.
  for (double at = best; at >= first; at -= at > best - 4.0 * coarse ? fine : coarse) {
    if (likelihood(at) > best_value - kThreshold) fit.low = at;
    else if (at < best - 8.0 * coarse) break;
    if (fit.low > at + 8.0 * coarse) break;
  }
  fit.high = best;
  for (double at = best; at <= last; at += at < best + 4.0 * coarse ? fine : coarse) {
    if (likelihood(at) > best_value - kThreshold) fit.high = at;
    else if (at > best + 8.0 * coarse) break;
  }
  fit.low = std::max(first, fit.low - fine);
  fit.high += fine;
  fit.has_upper = none < best_value - kThreshold;
  if (!fit.has_upper) fit.high = end;
  fit.num_beyond = static_cast<std::size_t>(std::ranges::count_if(
      likelihood.samples(), [&](const ReturnSample& sample) { return sample.value > fit.value; }));
  return fit;
}

std::pair<double, double> rough_limits(const std::vector<TwoLimitSample>& samples, double first_end,
                                       double second_end) {
  constexpr std::size_t kFirst = 100, kSecond = 100;
  constexpr double kSecondRatio = 1.05;
  const auto first_limit = [&](std::size_t i) { return first_end * static_cast<double>(i) / kFirst; };
  const auto second_limit = [&](std::size_t j) {
    return second_end * std::pow(kSecondRatio, static_cast<double>(j) - kSecond);
  };
  // Counts of beams and returns inside of each pair of limits: by cell, then cumulative in both directions.
  constexpr std::size_t kColumns = kSecond + 1;
  std::vector<double> beams((kFirst + 1) * kColumns, 0.0), returns(beams.size(), 0.0);
  for (const TwoLimitSample& sample : samples) {
    const auto i =
        static_cast<std::size_t>(std::clamp(std::ceil(sample.first / first_end * kFirst), 0.0, double{kFirst}));
    const double column =
        kSecond + std::ceil(std::log(std::max(1e-9, sample.second / second_end)) / std::log(kSecondRatio));
    const auto j = static_cast<std::size_t>(std::clamp(column, 0.0, double{kSecond}));
    beams[i * kColumns + j] += 1.0;
    if (sample.is_return) returns[i * kColumns + j] += 1.0;
  }
  for (std::vector<double>* counts : {&beams, &returns}) {
    for (std::size_t i = 0; i <= kFirst; ++i) {
      for (std::size_t j = 1; j <= kSecond; ++j) (*counts)[i * kColumns + j] += (*counts)[i * kColumns + j - 1];
    }
    for (std::size_t i = 1; i <= kFirst; ++i) {
      for (std::size_t j = 0; j <= kSecond; ++j) (*counts)[i * kColumns + j] += (*counts)[(i - 1) * kColumns + j];
    }
  }
  const double all = beams.back(), all_returns = returns.back();
  double best = log_binomial(all_returns, all);
  std::pair<double, double> limits = {first_end, second_end};
  for (std::size_t i = 1; i <= kFirst; ++i) {
    for (std::size_t j = 1; j <= kSecond; ++j) {
      const double inside = beams[i * kColumns + j], inside_returns = returns[i * kColumns + j];
      const double beyond = all - inside, beyond_returns = all_returns - inside_returns;
      const double value = log_binomial(inside_returns, inside) + log_beyond(beyond_returns, beyond);
      if (value <= best) continue;
      best = value;
      limits = {first_limit(i), second_limit(j)};
    }
  }
  return limits;
}

RateFit fit_dropouts(const std::vector<ReturnSample>& samples) {
  RateFit fit{.total = samples.size()};
  if (samples.empty()) return fit;
  std::size_t num_blocks = 0;
  for (const ReturnSample& sample : samples) num_blocks = std::max(num_blocks, sample.block + 1);
  std::vector<double> totals(num_blocks, 0.0), counts(num_blocks, 0.0);
  for (const ReturnSample& sample : samples) {
    totals[sample.block] += 1.0;
    if (!sample.is_return) counts[sample.block] += 1.0, ++fit.count;
  }
  const double n = static_cast<double>(fit.total), rate = static_cast<double>(fit.count) / n;
  double chi_squared = 0.0, num_used = 0.0;
  for (std::size_t b = 0; b < num_blocks; ++b) {
    if (totals[b] == 0.0 || rate <= 0.0 || rate >= 1.0) continue;
    const double deviation = counts[b] - rate * totals[b];
    chi_squared += deviation * deviation / (totals[b] * rate * (1.0 - rate));
    num_used += 1.0;
  }
  const double dispersion = num_used > 4.0 ? std::max(1.0, chi_squared / (num_used - 1.0)) : 1.0;
  const double z2 = 1.96 * 1.96 * dispersion;
  const double center = (rate + z2 / (2.0 * n)) / (1.0 + z2 / n);
  const double half = std::sqrt(z2 * (rate * (1.0 - rate) / n + z2 / (4.0 * n * n))) / (1.0 + z2 / n);
  fit.value = rate;
  fit.low = fit.count == 0 ? 0.0 : std::max(0.0, center - half);
  fit.high = std::min(1.0, center + half);
  return fit;
}

}  // namespace patrol::realism
