#include "slam/graph/range_noise.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace patrol::slam {
namespace {

constexpr std::size_t kMinDifferences = 1000;
constexpr double kMaxSpacing_m = 0.15;  ///< maximum distance between neighboring beams
constexpr double kMadOfStd = 0.6745;    ///< median absolute deviation of a normal distribution
constexpr double kMinAdapted_m = 0.04;
constexpr int kMaxRadiusCells = 10;
/// Noise of smoothed ranges, as a fraction of that of the measured ones: that of surfaces between corners is smaller.
constexpr double kSmoothed = 0.6;
/// Lengths in standard deviations of the smoothed ranges. Half of the noise is attributed to points, the remainder is
/// the thickness of the surfaces in the map.
constexpr double kRadius = 2.8, kFreeMargin = 3.5, kKernel = 2.5, kPointStd = 0.5;
/// Smallest distance between keyframes, as a fraction of the usual one.
constexpr double kMinKeyframeStep = 0.4;
/// Smallest number of keyframes per map, as a fraction of the usual one, and the noise from which it is the usual one.
constexpr double kMinSubmap = 0.5, kUsualSubmap_m = 0.2;

}  // namespace

void RangeNoiseEstimator::add(const LaserScan& scan) {
  const auto is_return = [&](std::size_t beam) {
    const float range = scan.ranges_m[beam];
    return std::isfinite(range) && range > 0.0F;
  };
  for (std::size_t beam = 1; beam + 1 < scan.ranges_m.size(); ++beam) {
    if (!is_return(beam - 1) || !is_return(beam) || !is_return(beam + 1)) continue;
    if (scan.ranges_m[beam] * std::abs(scan.angle_increment_rad) > kMaxSpacing_m) continue;
    differences_m_.push_back(
        std::abs(scan.ranges_m[beam] - 0.5F * (scan.ranges_m[beam - 1] + scan.ranges_m[beam + 1])));
  }
}

std::optional<double> RangeNoiseEstimator::std_m() const {
  if (differences_m_.size() < kMinDifferences) return std::nullopt;
  std::vector<float> sorted = differences_m_;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return *middle / (kMadOfStd * std::sqrt(1.5));
}

bool adapt_to_range_noise(double range_std_m, ScanTrackerSettings& settings) {
  if (range_std_m <= kMinAdapted_m) return false;
  const ScanTrackerSettings usual;
  ScanMatcherSettings& matching = settings.matching;
  const double smoothed_m = kSmoothed * range_std_m;
  const int radius = static_cast<int>(std::lround(kRadius * smoothed_m / settings.resolution_m));
  matching.surface_radius_cells = std::max(matching.surface_radius_cells, std::min(radius, kMaxRadiusCells));
  matching.kernel_m = std::max(matching.kernel_m, kKernel * smoothed_m);
  matching.point_std_m = std::max(matching.point_std_m, kPointStd * smoothed_m);
  settings.integration.free_margin_m = std::max(settings.integration.free_margin_m, kFreeMargin * smoothed_m);
  const double step = std::max(kMinKeyframeStep, kMinAdapted_m / range_std_m);
  settings.keyframe_distance_m = std::min(settings.keyframe_distance_m, step * usual.keyframe_distance_m);
  settings.keyframe_angle_rad = std::min(settings.keyframe_angle_rad, step * usual.keyframe_angle_rad);
  const double submap = std::clamp(range_std_m / kUsualSubmap_m, kMinSubmap, 1.0) * usual.submap_keyframes;
  settings.submap_keyframes = std::min(settings.submap_keyframes, static_cast<int>(std::lround(submap)));
  settings.groups_scans = true;
  return true;
}

}  // namespace patrol::slam
