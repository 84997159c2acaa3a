#pragma once

#include <string>

#include "core/frames.h"
#include "core/inspection_result.h"
#include "core/sensors/registry.h"
#include "core/tunnel_lining.h"
#include "inspect/lining/lining_settings.h"
#include "inspect/lining/reference.h"

namespace patrol::inspect {

/// Deformation of a lining from two panoramic scans (paper 004): the new one is laid on the reference, the rings are cut into cells by the clock,
/// and in each the lining is compared with itself, along the radius (the idea of M3C2: Lague, Brodu, Leroux 2013, with the design's
/// radius as the direction). What stands before the wall in either scan is left out.
///
/// Moves are seen against what most of the surroundings do: if all rings within reach and the ground move alike, nothing is found.
class LiningInspection {
 public:
  /// Throws InputError naming the setting that breaks its rule.
  LiningInspection(const LiningSettings& settings, const TunnelLining& design_in_map, const Pose3& T_body_scanner);

  LiningResult inspect(Time stamp, const std::string& station, const PanoramicScan& scan, const LiningReference& reference,
                       const Pose3& T_map_scanner_guess) const;

 private:
  LiningSettings settings_;
  TunnelLining design_;
  Pose2 T_scanner_body_;
};

}  // namespace patrol::inspect
