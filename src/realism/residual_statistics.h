#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "realism/beam.h"

namespace patrol::realism {

/// Distribution of residuals: recorded minus expected ranges.
struct ResidualDistribution {
  std::size_t count = 0;
  double median_m = 0.0;      ///< signed
  double median_abs_m = 0.0;  ///< median of the absolute values
  double p95_abs_m = 0.0;     ///< 95 % of the absolute values are below
  double spread_m = 0.0;      ///< robust standard deviation: 1.4826 times the median absolute deviation
};

/// Returns the distribution; all zero for an empty list.
ResidualDistribution distribution_of(std::vector<double> residuals_m);

/// Kolmogorov-Smirnov distance: maximum difference of the two cumulative distributions, 0 to 1. NaN if a list is empty.
double ks_distance(std::vector<double> first, std::vector<double> second);

/// Row of a table of residuals: beams of one bin.
struct ResidualBin {
  double low = 0.0, high = 0.0;   ///< limits of the bin
  std::size_t num_expected = 0;   ///< beams on a smooth surface, with and without return
  std::size_t num_dropouts = 0;   ///< expected beams without return
  std::size_t num_moving = 0;     ///< expected beams that are moving or unmapped
  ResidualDistribution residual;  ///< residuals of the static beams

  double dropout_rate() const {
    return num_expected == 0 ? 0.0 : static_cast<double>(num_dropouts) / static_cast<double>(num_expected);
  }
};

/// Groups the beams by a value into bins of equal width from `low`; beams outside of all bins are left out.
std::vector<ResidualBin> bins_of(const std::vector<Beam>& beams, const std::function<double(const Beam&)>& value,
                                 double low, double width, std::size_t count);

/// Returns the residuals of the beams of a class.
std::vector<double> residuals_of(const std::vector<Beam>& beams, BeamClass kind);
std::size_t count_of(const std::vector<Beam>& beams, BeamClass kind);

}  // namespace patrol::realism
