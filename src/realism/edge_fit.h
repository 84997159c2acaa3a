#pragma once

#include <cstddef>
#include <vector>

#include "realism/beam.h"
#include "realism/posed_scan.h"
#include "realism/simulated_scans.h"
#include "realism/site.h"

namespace patrol::realism {

/// Return of the first beam after a jump of the range, with the ranges of the site about it.
struct EdgeSample {
  double recorded_m = 0.0;
  std::vector<float> range_m = {};  ///< expected with systematic errors, [offset of the azimuth]; infinite: no return
  std::vector<float> light = {};    ///< returned light, [offset]; 0 without return
  std::vector<float> previous_m = {};  ///< expected range of the previous beam, [offset], over half of the offsets

  /// Whether the surfaces of this and the previous beam return without angle noise.
  bool has_both_returns() const;
};

/// Casts the fan of rays about a beam after a jump. `device`: settings and systematic errors by the other fits.
EdgeSample edge_sample(const Site& site, const PosedScan& posed, const Beam& beam, const LidarDevice& device);

/// Width of the beam with its 95 % profile interval.
struct EdgeFit {
  double width_deg = 0.0;
  double low_deg = 0.0, high_deg = 0.0;
  bool has_upper = false;      ///< whether the interval ends below the largest width of the search, 2 degrees
  double outlier_ratio = 0.0;  ///< fraction of the samples that no width explains
  std::size_t num_samples = 0;
};

/// Range of the angle noise, from the fit of the smooth surfaces.
struct AngleNoiseRange {
  double value_deg = 0.0, low_deg = 0.0, high_deg = 0.0;
};

/// Fits the beam width to mixed pixels: the mean range over the width by the lidar model, where the range jumps by 0.1
/// to 1.5 m from the previous beam, marginalized over the angle noise of both beams. The angle noise is profiled within
/// its interval. The interval is where the log-likelihood is at most 3.0 below its maximum, and 0.01 deg more to each
/// side, half the step of the sampled angle noise. `device`: range noise and quantization step.
EdgeFit fit_beam_width(const std::vector<EdgeSample>& samples, const LidarDevice& device,
                       const AngleNoiseRange& angle_noise);

}  // namespace patrol::realism
