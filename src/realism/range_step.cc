#include "realism/range_step.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace patrol::realism {
namespace {

constexpr double kMinStep_m = 1e-4;

/// Rounding error of a range in single precision, with a margin for texts of few digits.
double tolerance_m(double range_m) { return 2e-7 * range_m + 1e-8; }

/// Refines a step on the differences of ranges in increasing order to the first one: the number of steps of each is
/// certain once the step is known well enough from the shorter ones. Returns 0 if a difference is off the lattice.
double refined_step(const std::vector<double>& sorted_m, double step_m) {
  constexpr double kMaxOff = 0.2;  // of a step
  double sum_nn = 0.0, sum_nr = 0.0;
  for (const double range_m : sorted_m) {
    const double difference_m = range_m - sorted_m.front(), n = std::round(difference_m / step_m);
    if (n < 1.0) continue;
    if (std::abs(difference_m - n * step_m) > kMaxOff * step_m) return 0.0;
    sum_nn += n * n, sum_nr += n * difference_m;
    step_m = sum_nr / sum_nn;
  }
  return step_m;
}

bool is_lattice(const std::vector<double>& sorted_m, double step_m) {
  return std::ranges::all_of(sorted_m, [&](double range_m) {
    return std::abs(range_m - step_m * std::round(range_m / step_m)) <= 4.0 * tolerance_m(range_m);
  });
}

}  // namespace

FittedParameter fit_range_step(const std::vector<float>& ranges_m) {
  FittedParameter step{.name = "range_quantization_m"};
  std::vector<double> sorted_m;
  for (const float range_m : ranges_m) {
    if (std::isfinite(range_m) && range_m > 0.0f) sorted_m.push_back(static_cast<double>(range_m));
  }
  std::sort(sorted_m.begin(), sorted_m.end());
  sorted_m.erase(std::unique(sorted_m.begin(), sorted_m.end()), sorted_m.end());
  constexpr std::size_t kMinRanges = 30;
  step.high = kMinStep_m;
  if (sorted_m.size() < kMinRanges) {
    step.reason = "too few different ranges";
    step.high = sorted_m.empty() ? 1.0 : sorted_m.back();
    return step;
  }
  double gap_m = sorted_m.back();
  for (std::size_t i = 1; i < sorted_m.size(); ++i) {
    const double difference_m = sorted_m[i] - sorted_m[i - 1];
    if (difference_m > 8.0 * tolerance_m(sorted_m[i])) gap_m = std::min(gap_m, difference_m);
  }
  if (gap_m >= kMinStep_m) {
    // The smallest gaps are the step or a small multiple of it; their mean has the rounding errors averaged.
    double sum_m = 0.0, count = 0.0;
    for (std::size_t i = 1; i < sorted_m.size(); ++i) {
      const double difference_m = sorted_m[i] - sorted_m[i - 1];
      if (difference_m > 0.8 * gap_m && difference_m < 1.4 * gap_m) sum_m += difference_m, count += 1.0;
    }
    for (int divisor = 1; divisor <= 5; ++divisor) {
      const double step_m = refined_step(sorted_m, sum_m / count / divisor);
      if (step_m < kMinStep_m || !is_lattice(sorted_m, step_m)) continue;
      const double half_width_m = 4.0 * tolerance_m(sorted_m.back()) / std::round(sorted_m.back() / step_m);
      return {.name = step.name,
              .value = step_m,
              .low = step_m - half_width_m,
              .high = step_m + half_width_m,
              .is_seen = true};
    }
  }
  step.reason = "the ranges are on no lattice: the step is below 0.1 mm, or the ranges were changed after rounding";
  return step;
}

}  // namespace patrol::realism
