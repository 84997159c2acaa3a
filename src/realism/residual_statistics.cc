#include "realism/residual_statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace patrol::realism {
namespace {

/// Percentile with linear interpolation of a list, which is reordered.
double percentile_of(std::vector<double>& values, double fraction) {
  const double position = fraction * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(below);
  std::nth_element(values.begin(), at, values.end());
  const double low = *at;
  if (below + 1 >= values.size()) return low;
  const double high = *std::min_element(at + 1, values.end());
  return low + (position - static_cast<double>(below)) * (high - low);
}

}  // namespace

ResidualDistribution distribution_of(std::vector<double> residuals_m) {
  ResidualDistribution result{.count = residuals_m.size()};
  if (residuals_m.empty()) return result;
  result.median_m = percentile_of(residuals_m, 0.5);
  std::vector<double> absolute = residuals_m;
  for (double& value : absolute) value = std::abs(value);
  result.median_abs_m = percentile_of(absolute, 0.5);
  result.p95_abs_m = percentile_of(absolute, 0.95);
  for (double& value : residuals_m) value = std::abs(value - result.median_m);
  result.spread_m = 1.4826 * percentile_of(residuals_m, 0.5);
  return result;
}

double ks_distance(std::vector<double> first, std::vector<double> second) {
  if (first.empty() || second.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(first.begin(), first.end());
  std::sort(second.begin(), second.end());
  double distance = 0.0;
  std::size_t i = 0, j = 0;
  while (i < first.size() && j < second.size()) {
    const double value = std::min(first[i], second[j]);
    while (i < first.size() && first[i] <= value) ++i;
    while (j < second.size() && second[j] <= value) ++j;
    distance = std::max(distance, std::abs(static_cast<double>(i) / static_cast<double>(first.size()) -
                                           static_cast<double>(j) / static_cast<double>(second.size())));
  }
  return distance;
}

std::vector<ResidualBin> bins_of(const std::vector<Beam>& beams, const std::function<double(const Beam&)>& value,
                                 double low, double width, std::size_t count) {
  std::vector<ResidualBin> bins(count);
  std::vector<std::vector<double>> residuals(count);
  for (std::size_t b = 0; b < count; ++b) {
    bins[b].low = low + width * static_cast<double>(b);
    bins[b].high = low + width * static_cast<double>(b + 1);
  }
  for (const Beam& beam : beams) {
    if (!beam.expected.is_smooth || beam.expected.is_glass || beam.kind == BeamClass::kNear) continue;
    const double position = std::floor((value(beam) - low) / width);
    if (!(position >= 0.0 && position < static_cast<double>(count))) continue;
    const auto b = static_cast<std::size_t>(position);
    ++bins[b].num_expected;
    if (beam.kind == BeamClass::kDropout) ++bins[b].num_dropouts;
    if (beam.kind == BeamClass::kMoving) ++bins[b].num_moving;
    if (beam.kind == BeamClass::kStatic) residuals[b].push_back(beam.residual_m());
  }
  for (std::size_t b = 0; b < count; ++b) bins[b].residual = distribution_of(std::move(residuals[b]));
  return bins;
}

std::vector<double> residuals_of(const std::vector<Beam>& beams, BeamClass kind) {
  std::vector<double> residuals;
  for (const Beam& beam : beams) {
    if (beam.kind == kind) residuals.push_back(beam.residual_m());
  }
  return residuals;
}

std::size_t count_of(const std::vector<Beam>& beams, BeamClass kind) {
  return static_cast<std::size_t>(std::ranges::count(beams, kind, &Beam::kind));
}

}  // namespace patrol::realism
