#pragma once

#include <string>

#include "core/frames.h"
#include "core/inspection_result.h"
#include "core/sensors/registry.h"
#include "core/tunnel_lining.h"
#include "inspect/lining/lining_settings.h"
#include "inspect/lining/reference.h"

namespace patrol::inspect {

/// Tunnel-lining deformation from two terrestrial laser scans [Liu21]. The new scan is registered to the reference,
/// each ring is divided into angular cells, and the radial displacement of each cell is estimated. The method is M3C2
/// [Lague13] with the design radius as direction. Objects in front of the wall in either scan are excluded.
///
/// Displacements are relative to the majority of the surroundings: a common motion of all rings in range and the ground
/// is not detected.
class LiningInspection {
 public:
  /// Creates the inspection. Throws InputError with the name of an invalid setting.
  LiningInspection(const LiningSettings& settings, TunnelLining design_in_map, const Pose3& T_body_scanner);

  /// Compares a scan with the reference scan of the station. `T_map_scanner_guess`: pose estimate of the robot.
  LiningResult inspect(Time stamp, const std::string& station, const PanoramicScan& scan,
                       const LiningReference& reference, const Pose3& T_map_scanner_guess) const;

 private:
  LiningSettings settings_;
  TunnelLining design_;
  Pose2 T_scanner_body_;
};

}  // namespace patrol::inspect
