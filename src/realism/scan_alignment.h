#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "core/settings.h"
#include "realism/beam.h"
#include "realism/posed_scan.h"
#include "realism/site.h"
#include "sim/as_built/sensor_errors.h"

namespace patrol::realism {

/// Alignment of single scans to the site: planar correction of the pose by the distances of the returns from the
/// tangent planes of the expected surfaces, with Tukey's robust weights and the accuracy of the path as a prior.
struct AlignmentSettings {
  int iterations = 4;            ///< re-casts of the expected surfaces
  double position_std_m = 0.10;  ///< prior standard deviation of each coordinate of the path
  double yaw_std_deg = 1.0;      ///< prior standard deviation of the heading of the path
  double distance_std_m = 0.03;  ///< standard deviation of a return from its surface
  double max_distance_m = 0.3;   ///< distance from which on a return has no weight
  int min_beams = 20;            ///< scans with fewer returns on smooth surfaces keep the pose of the path

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("iterations", self.iterations, between(1, 50));
    visit("position_std_m", self.position_std_m, between(1e-4, 10.0));
    visit("yaw_std_deg", self.yaw_std_deg, between(1e-3, 90.0));
    visit("distance_std_m", self.distance_std_m, between(1e-4, 1.0));
    visit("max_distance_m", self.max_distance_m, between(1e-3, 10.0));
    visit("min_beams", self.min_beams, between(3, 100000));
  }
};

/// Result of the alignment of a scan.
struct ScanAlignment {
  PosedScan posed;                                       ///< scan at the corrected poses
  Eigen::Vector3d correction = Eigen::Vector3d::Zero();  ///< x, y in site, m; yaw, rad
  std::size_t num_beams = 0;                             ///< returns on smooth surfaces
  /// Fraction of a constant error of all ranges that this alignment removes, 0 to 1: high where the surfaces are on one
  /// side, low in a closed room.
  double absorbed_bias = 0.0;
};

/// Aligns a scan after subtracting systematic range errors (an estimate) from its ranges.
ScanAlignment align_scan(const Site& site, const PosedScan& posed, const BeamRules& rules,
                         const AlignmentSettings& settings, const sim::LidarErrors& errors = {});

/// Least squares of the systematic range errors - offset, scale, incidence, reflectivity - over aligned scans, with the
/// planar correction of every scan as a nuisance (eliminated scan by scan). Weak priors keep errors finite that the
/// scans do not constrain.
class SystematicErrorFit {
 public:
  explicit SystematicErrorFit(const AlignmentSettings& settings);

  /// Adds an aligned scan with its expected beams; `errors` are those that its alignment subtracted.
  void add(const ScanAlignment& aligned, const std::vector<ExpectedBeam>& expected, const sim::LidarErrors& errors);

  /// Returns `errors` with the remaining ones added.
  sim::LidarErrors improved(const sim::LidarErrors& errors) const;

  /// Ratio of the standard deviation of each error to that at known poses, at least 1.
  std::array<double, 4> interval_factors() const;

 private:
  AlignmentSettings settings_;
  Eigen::Matrix4d information_, information_at_known_poses_;
  Eigen::Vector4d gradient_ = Eigen::Vector4d::Zero();
};

}  // namespace patrol::realism
