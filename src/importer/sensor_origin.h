#pragma once

namespace patrol::importer {

inline constexpr double kMountTolerance_m = 0.003;  ///< default of as_built.mounting.position_m
/// Tilt of the scan plane of a 2D lidar above which it is reported. [Assumption]
inline constexpr double kMaxScanTilt_rad = 0.1745;

}  // namespace patrol::importer
