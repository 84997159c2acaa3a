#pragma once

#include <optional>

namespace patrol::importer {

// Defaults of stack.scan_leveling (localize/scan_leveler_settings.h).
inline constexpr double kDefaultMinHitHeight_m = 0.15;
inline constexpr double kDefaultSelfFilterRadius_m = 0.32;
inline constexpr double kDefaultTiltMargin_rad = 0.008;

/// Settings of stack.scan_leveling that follow from the size of a robot.
struct ScanBand {
  double min_height_m = kDefaultMinHitHeight_m;
  double self_filter_radius_m = kDefaultSelfFilterRadius_m;
};

/// Returns the settings for a lidar `lidar_height_m` above the ground, on a robot whose outline is within
/// `outline_radius_m` of the vertical axis of the body. Returns none if the defaults keep the hits of a level beam up
/// to 10 m. Otherwise, hits count above 0.4 of the height of the lidar, and the radius of the self filter is that of
/// the outline with a margin of 5 cm, at most the default.
std::optional<ScanBand> scan_band_of(double lidar_height_m, double outline_radius_m);

}  // namespace patrol::importer
