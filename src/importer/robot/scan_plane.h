#pragma once

namespace patrol::importer {

/// Tilt of the scan plane of a 2D lidar above which it is reported. [Assumption]
inline constexpr double kMaxScanTilt_deg = 10.0;

}  // namespace patrol::importer
