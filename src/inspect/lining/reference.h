#pragma once

#include <vector>

#include "core/frames.h"
#include "core/sensors/registry.h"

namespace patrol::inspect {

/// What is kept of the first scan of a station.
struct LiningReference {
  Pose3 T_map_scanner;               ///< where it was made; x of `scanner_level`
  std::vector<ScannerPoint> points;  ///< in map, each a mean of neighbouring beams; its intensity likewise
};

struct ReferenceSettings {
  double spacing_m = 0.1;  ///< points are averaged over that
  double near_m = 1.5;     ///< nearer to the scanner is the robot itself
  double far_m = 30.0;     ///< farther away points are too thin to be surfaces
};

LiningReference make_reference(const PanoramicScan& scan, const Pose3& T_map_scanner, const ReferenceSettings& settings = {});

}  // namespace patrol::inspect
