#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/frames.h"
#include "inspect/lining/lining_grid.h"
#include "inspect/lining/lining_settings.h"
#include "inspect/lining/reference_lining.h"
#include "inspect/lining/surface_cloud.h"

namespace patrol::inspect {

/// Parameters: translation and rotation of a step about the scanner, in map, and the range offset of the scanner.
using Vector7 = Eigen::Matrix<double, 7, 1>;
using Matrix7 = Eigen::Matrix<double, 7, 7>;

/// Mean offset of the new scan from the reference over a surface patch.
struct Patch {
  int cell = -1;                ///< cell of the lining; -1: another surface
  double offset_m = 0.0;        ///< inward for the lining, otherwise along the surface normal toward the scanner
  double var_m2 = 0.0;          ///< from the scatter of both scans, plus unmodeled surface effects
  Vector7 J = Vector7::Zero();  ///< derivative of the offset with respect to the parameters
  int points = 0;               ///< number of points of the new scan, before downsampling
  double square_m2 = 0.0;       ///< mean squared deviation of the point offsets from the patch offset
};

struct Adjustment {
  Pose3 T_map_scanner;
  double range_offset_m = 0.0;  ///< range error of the new scan relative to the reference; positive: too long
  Matrix7 covariance = Matrix7::Identity();
  /// Factor by which the patch standard deviations were increased to match the residuals; at least 1.
  double scale = 1.0;
  double angle_var_rad2 = 0.0;  ///< variance of the systematic angle errors of both scans together
  std::vector<Patch> patches;   ///< patches at the final pose
  std::vector<double> weights;  ///< [patch], robust weight 0 to 1; 0 for deformed patches
  double rms_m = 0.0;           ///< root mean square offset of the points in the inlier patches
};

/// Refines the registration to millimeters: least squares over surface patches, which are the cells of the lining and
/// 0.5 m pieces of all other surfaces. Each patch has one residual with its own standard deviation, so that correlated
/// point residuals count once. Deformed patches are down-weighted with Tukey's biweight (the "stable areas" of
/// [Wujanz16]). The pose estimate of the robot is a prior for the degenerate directions.
Adjustment adjust(const LiningInMap& lining, const LiningGrid& grid, const ReferenceLining& reference,
                  const SurfaceCloud& target_map, const SurfaceCloud& source, const Pose3& T_map_scanner_start,
                  const Pose3& T_map_scanner_guess, const LiningSettings& settings);

}  // namespace patrol::inspect
