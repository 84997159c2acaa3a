#pragma once

#include <vector>

#include "core/frames.h"
#include "core/sensors/registry.h"

namespace patrol::inspect {

/// Stored reference scan of a station.
struct LiningReference {
  Pose3 T_map_scanner;               ///< pose of `scanner_level`, the upright scanner frame
  std::vector<ScannerPoint> points;  ///< points in map; position and intensity are means of neighboring beams
};

struct ReferenceSettings {
  double spacing_m = 0.1;     ///< averaging distance of the points
  double min_range_m = 1.5;   ///< points closer to the scanner are excluded as parts of the robot
  double max_range_m = 30.0;  ///< points farther away are excluded: too sparse for surfaces
};

/// Creates a reference from a scan and its pose.
LiningReference make_reference(const PanoramicScan& scan, const Pose3& T_map_scanner,
                               const ReferenceSettings& settings = {});

}  // namespace patrol::inspect
