#pragma once

#include <functional>
#include <vector>

#include "core/settings.h"
#include "realism/lidar_fit.h"
#include "realism/scan_alignment.h"

namespace patrol::realism {

struct PositionSettings {
  bool align = true;     ///< whether each scan is aligned to the site; false: the path is exact
  int error_passes = 4;  ///< alignments, each with the systematic range errors that the one before leaves
  BeamRules rules;
  AlignmentSettings alignment;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("align", self.align);
    visit("error_passes", self.error_passes, between(1, 20));
    visit("rules", self.rules);
    visit("alignment", self.alignment);
  }
};

/// Scans at their poses in the site with what the alignment changed.
struct PositionedScans {
  ScanSet set;
  std::vector<Eigen::Vector3d> corrections;  ///< [scan]: x, y in site, m; yaw, rad; empty without alignment
  sim::LidarErrors errors;                   ///< systematic range errors that the last alignment subtracted
};

/// Positions scans in the site and computes their beams. Alignment and systematic range errors are estimated in turn,
/// the errors with the poses as nuisance, so that what an alignment absorbs is not lost. `on_scan` is called
/// with the number of scans done, of all passes, and returns false to stop; the result is then incomplete.
PositionedScans position_scans(const Site& site, const std::vector<PosedScan>& scans, const PositionSettings& settings,
                               const std::function<bool(std::size_t done, std::size_t total)>& on_scan = {});

}  // namespace patrol::realism
