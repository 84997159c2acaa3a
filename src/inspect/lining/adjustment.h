#pragma once

#include <Eigen/Core>

#include <vector>

#include "core/frames.h"
#include "inspect/lining/lining_grid.h"
#include "inspect/lining/lining_settings.h"
#include "inspect/lining/reference_lining.h"
#include "inspect/lining/surface_cloud.h"

namespace patrol::inspect {

/// What is estimated: a step's way and turn about the scanner, in map, and the scanner's range offset.
using Vector7 = Eigen::Matrix<double, 7, 1>;
using Matrix7 = Eigen::Matrix<double, 7, 7>;

/// The mean over a patch of surface, of the new scan against the reference.
struct Patch {
  int cell = -1;           ///< of the lining; -1: another surface
  double offset_m = 0.0;   ///< of the lining inwards, otherwise along the surface's normal
  double var_m2 = 0.0;     ///< of both scans' scatter, and of what that does not show
  Vector7 J = Vector7::Zero();  ///< its derivative with what is estimated
  int points = 0;          ///< of the new scan, before thinning
  double square_m2 = 0.0;  ///< mean of the points' squared offsets about the patch's
};

struct Adjustment {
  Pose3 T_map_scanner;
  double range_offset_m = 0.0;      ///< ranges of the new scan are too long by that, against the reference's
  Matrix7 covariance = Matrix7::Identity();
  double scale = 1.0;               ///< standard deviations of the patches were that many times too small, and have been corrected
  std::vector<Patch> patches;       ///< at the end
  std::vector<double> weights;      ///< [patch], 0 ... 1: one that has moved has 0
  double rms_m = 0.0;               ///< of the points of patches that were kept
};

/// The last step of registration, where millimetres count: least squares over patches, the cells of the lining and half a metre of everything
/// else, each with its own standard deviation, so that residuals that belong together count once. Patches that do not fit to what most say have
/// moved and do not pull (Tukey's biweight; "stable areas", as in Wujanz, "Terrestrial Laser Scanning for Geodetic Deformation Monitoring",
/// 2016). The robot's own estimate is a prior, which holds what no surface does.
Adjustment adjust(const LiningInMap& lining, const LiningGrid& grid, const ReferenceLining& reference, const SurfaceCloud& target_map,
                  const SurfaceCloud& source, const Pose3& T_map_scanner_start, const Pose3& T_map_scanner_guess, const LiningSettings& settings);

}  // namespace patrol::inspect
