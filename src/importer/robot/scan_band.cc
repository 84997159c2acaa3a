#include "importer/robot/scan_band.h"

#include <algorithm>
#include <cmath>

namespace patrol::importer {

std::optional<ScanBand> scan_band_of(double lidar_height_m, double outline_radius_m) {
  constexpr double kNeededReach_m = 10.0, kHeightRatio = 0.4, kMargin_m = 0.05, kStep_m = 0.01;
  // A level beam leaves the band where its lower edge, min + margin s, reaches the height of the beam.
  if (lidar_height_m >= kDefaultMinHitHeight_m + kNeededReach_m * kDefaultTiltMargin_rad) return std::nullopt;
  return ScanBand{
      .min_height_m = std::max(kStep_m, kStep_m * std::floor(kHeightRatio * lidar_height_m / kStep_m + 1e-6)),
      .self_filter_radius_m =
          std::min(kDefaultSelfFilterRadius_m, kStep_m * std::ceil((outline_radius_m + kMargin_m) / kStep_m - 1e-6))};
}

}  // namespace patrol::importer
