#pragma once

#include <vector>

#include "core/inspection_result.h"
#include "inspect/lining/adjustment.h"
#include "inspect/lining/lining_grid.h"
#include "inspect/lining/lining_settings.h"

namespace patrol::inspect {

/// Returns the displacements of the cells. The standard deviations include the uncertainty of the registration.
std::vector<LiningCell> lining_cells(const LiningGrid& grid, const Adjustment& adjustment);

/// Displacement of a ring in one sector. `smoothed_ring` fits a parabola to five neighbors where all are known
/// [Savitzky64], which preserves the height of a bulge. Without smoothing, the maximum over the sectors of a ring would
/// be biased by noise.
struct SectorDisplacement {
  bool is_observed = false;
  double inward_m = 0.0;
  double residual_var_m2 = 0.0;  ///< variance without the registration uncertainty
  Vector7 J = Vector7::Zero();   ///< derivative with respect to the parameters of the registration
};
std::vector<SectorDisplacement> smoothed_ring(const LiningGrid& grid, const Adjustment& adjustment, int ring);

/// Returns the rings with a displacement of at least the notice threshold and at least `significance` standard
/// deviations.
std::vector<RingFinding> ring_findings(const LiningInMap& lining, const LiningGrid& grid, const Adjustment& adjustment,
                                       const LiningSettings& settings);

/// Returns the convergence lines of each ring. "9-3", "10-2", "12-9" and "12-3" are chords, lengthening positive; "12-"
/// is the height of the crown, rising positive. Scans show the radial part of a displacement only: points that slide
/// along the lining are not detected. Lines with unobserved ends are omitted.
std::vector<ConvergenceLine> convergence_lines(const LiningInMap& lining, const LiningGrid& grid,
                                               const Adjustment& adjustment);

}  // namespace patrol::inspect
