#pragma once

#include <vector>

#include "core/frames.h"
#include "core/messages.h"

namespace patrol::inspect {

/// What is kept of the first scan of a station.
struct LiningReference {
  Pose3 T_map_scanner;               ///< where it was made; x of `scanner_level`
  std::vector<ScannerPoint> points;  ///< in map, each the mean of a voxel
};

/// Thinned; a voxel's intensity is the mean. Points beyond `end_m` from the scanner are too far apart to be surfaces.
LiningReference make_reference(const PanoramicScan& scan, const Pose3& T_map_scanner, double spacing_m = 0.08, double end_m = 40.0);

}  // namespace patrol::inspect
