#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/settings.h"
#include "realism/beam.h"
#include "realism/fitted_parameter.h"
#include "realism/posed_scan.h"
#include "realism/simulated_scans.h"
#include "realism/site.h"

namespace patrol::realism {

struct LidarFitSettings {
  int max_hits = 20000;           ///< returns on smooth surfaces that are used, evenly over the log
  int max_edges = 1500;           ///< beams after jumps of the range that are used
  int blocks = 20;                ///< groups of consecutive scans for correlated errors
  double path_yaw_std_deg = 0.0;  ///< remaining error of the heading of the path; blurs the limit of the incidence
  double path_std_m = 0.0;        ///< remaining error of the position of the path; blurs the limit of the range

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("max_hits", self.max_hits, between(1000, 1000000));
    visit("max_edges", self.max_edges, between(30, 100000));
    visit("blocks", self.blocks, between(5, 1000));
    visit("path_yaw_std_deg", self.path_yaw_std_deg, between(0.0, 10.0));
    visit("path_std_m", self.path_std_m, between(0.0, 1.0));
  }
};

/// Scans on the site, with their beams.
struct ScanSet {
  std::vector<PosedScan> scans;
  std::vector<Beam> beams;     ///< beams of all scans, in order
  BeamRules rules;             ///< rules of the classes of the beams
  double absorbed_bias = 0.0;  ///< mean fraction of a constant range error that the alignment of the scans removes
  /// Factors on the intervals of offset, scale, incidence and reflectivity for the poses that were fitted with them.
  std::array<double, 4> interval_factors = {1.0, 1.0, 1.0, 1.0};
  /// Factor on the range noise for the three parameters of each scan's pose that were fitted to its returns.
  double noise_factor = 1.0;

  void append(PosedScan posed, const std::vector<ExpectedBeam>& expected);
};

/// Parameters of a lidar by its recorded scans.
struct LidarFit {
  std::vector<FittedParameter> parameters;  ///< settings and systematic errors, each once
  double outlier_ratio = 0.0;               ///< fraction of the returns that the site and the model do not explain
  double edge_outlier_ratio = 0.0;          ///< fraction of the returns after jumps that no beam width explains
  std::size_t num_hits = 0, num_edges = 0, num_returns = 0;

  const FittedParameter& of(const std::string& name) const;
  /// Returns the device of the fit: seen parameters have their fitted values; the others keep those of `base`, moved
  /// into the interval.
  LidarDevice device(const LidarDevice& base) const;
};

/// Fits noise, systematic errors, drop-outs, limits of incidence and range, beam width, false returns and quantization
/// step to the beams. `base`: values of what is neither fitted nor in the log.
LidarFit fit_lidar(const Site& site, const ScanSet& set, const LidarDevice& base, const LidarFitSettings& settings);

}  // namespace patrol::realism
