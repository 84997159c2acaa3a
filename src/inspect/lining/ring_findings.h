#pragma once

#include <vector>

#include "core/inspection_result.h"
#include "inspect/lining/adjustment.h"
#include "inspect/lining/lining_grid.h"
#include "inspect/lining/lining_settings.h"

namespace patrol::inspect {

/// The cells' displacements, with what the registration leaves open as a part of each one's standard deviation.
std::vector<LiningCell> lining_cells(const LiningGrid& grid, const Adjustment& adjustment);

/// A ring's displacement in each sector, smoothed where five neighbours are known: a parabola through them (Savitzky, Golay 1964), which
/// keeps a bulge's height. The reported place of a ring is the one that has moved most, so noise would make it larger.
struct SectorMove {
  bool is_known = false;
  double inward_m = 0.0;
  double own_var_m2 = 0.0;            ///< without registration
  Vector7 J = Vector7::Zero();        ///< derivative with what the registration has estimated
};
std::vector<SectorMove> smoothed_ring(const LiningGrid& grid, const Adjustment& adjustment, int ring);

/// Rings that have moved inwards or outwards by the notice's threshold or more, and by `significance` standard deviations or more.
std::vector<RingFinding> ring_findings(const LiningInMap& lining, const LiningGrid& grid, const Adjustment& adjustment, const LiningSettings& settings);

/// "9-3", "10-2", "12-9", "12-3" as chords, longer is positive; "12-" is the height of the crown, higher is positive. Only the radial part
/// of a move is seen in a scan: marks that slide along the lining stay unnoticed. Lines whose marks are not seen are left out.
std::vector<ConvergenceLine> convergence_lines(const LiningInMap& lining, const LiningGrid& grid, const Adjustment& adjustment);

}  // namespace patrol::inspect
