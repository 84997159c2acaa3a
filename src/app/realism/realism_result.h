#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/settings.h"
#include "io/files/table.h"
#include "io/json/metrics_json.h"
#include "realism/residual_statistics.h"
#include "realism/scan_positions.h"

namespace patrol::app {

/// Recorded scans and scans of the same lidar by simulation, on the same site.
struct RealismResult {
  realism::PositionedScans recorded;
  realism::PositionedScans simulated;  ///< at the poses of the recorded ones, positioned in the same way

  realism::ResidualDistribution residual() const;            ///< residuals of the recorded static surfaces
  realism::ResidualDistribution simulated_residual() const;  ///< residuals of the simulated static surfaces
  double ks() const;                                         ///< distance of these two
};

/// Simulates the lidar at the poses of the recorded scans. The simulated scans are aligned to the site like the
/// recorded ones. `on_scan` as in realism::position_scans.
realism::PositionedScans simulate_like(const realism::Site& site, const realism::PositionedScans& recorded,
                                       const realism::LidarDevice& device, const realism::PositionSettings& settings,
                                       std::uint64_t seed,
                                       const std::function<bool(std::size_t, std::size_t)>& on_scan = {});

/// Table by range, incidence and azimuth: one group of rows each, recorded and simulated.
struct BinnedResiduals {
  std::string name, unit;
  std::vector<realism::ResidualBin> recorded, simulated;
};
std::vector<BinnedResiduals> binned_residuals(const RealismResult& result);
io::Table residual_table(const std::vector<BinnedResiduals>& groups);

io::Metrics metrics_of(const RealismResult& result);

/// Fraction of static returns among the static and the moving or unmapped ones. It is small in another site than that
/// of the log, or on a wrong path.
double static_ratio(const std::vector<realism::Beam>& beams);

/// Summary for a terminal, with a warning if most returns are not on surfaces of the site.
std::string summary_text(const RealismResult& result);

}  // namespace patrol::app
