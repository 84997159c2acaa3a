#include "importer/site/points/intensity_scale.h"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

namespace patrol::importer {

float IntensityScale::light_of(float intensity) const { return std::clamp(factor * (intensity - black), 0.0f, 1.0f); }

IntensityScale scale_of(float largest) {
  if (largest <= 0.0f) return {.factor = 0.0f, .rule = "the points have no intensity: reflectivity 0.5 everywhere"};
  const float full = largest <= 1.0f ? 1.0f : (largest <= 255.0f ? 255.0f : std::max(largest, 65535.0f));
  return {.factor = 1.0f / full, .rule = fmt::format("an intensity of {:g} is that of a white surface", full)};
}

IntensityScale scale_of_cloud(const std::vector<ScannerPoint>& points) {
  constexpr double kBright = 0.99;
  constexpr float kMinBright = 0.5f;
  if (points.empty()) return scale_of(0.0f);
  std::vector<float> intensities;
  for (const ScannerPoint& point : points) intensities.push_back(point.intensity);
  const auto [smallest, largest] = std::minmax_element(intensities.begin(), intensities.end());
  const float black = std::min(0.0f, *smallest);
  IntensityScale scale = scale_of(*largest - black);
  scale.black = black;
  if (!scale.is_known()) return scale;
  const auto bright = intensities.begin() + static_cast<std::ptrdiff_t>(kBright * static_cast<double>(points.size()));
  std::nth_element(intensities.begin(), bright, intensities.end());
  const float range = *bright - black;
  if (range > 0.0f && scale.factor * range < kMinBright) {
    scale.factor = 1.0f / range;
    scale.rule =
        fmt::format("an intensity of {:g}, which {:g} % of the points do not exceed, is that of a white surface",
                    *bright, 100.0 * kBright);
  }
  if (black < 0.0f) scale.rule += fmt::format(", {:g} that of a black one", black);
  return scale;
}

}  // namespace patrol::importer
