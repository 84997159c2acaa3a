#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "slam/match_points.h"

namespace patrol::slam {

/// Gain in log likelihood of one pose over another by the bearing of the points in body. A moving object has many
/// points in few sectors.
class SectorGains {
 public:
  static constexpr std::size_t kSectors = 36;

  /// `a`, `b`: log likelihoods at the two poses [point], NaN in unknown cells; `unknown` replaces NaN.
  SectorGains(const std::vector<MatchPoint>& points, const std::vector<double>& a, const std::vector<double>& b,
              double unknown);

  static std::size_t sector_of(const MatchPoint& point);
  double total() const { return total_; }
  /// Returns the vote of a sector: 1 in favor of `a`, -1 against, 0 undecided.
  int vote(std::size_t sector) const;
  /// Returns the number of sectors in favor of `a` minus the number against.
  int votes() const;

 private:
  std::array<double, kSectors> gains_{};
  double total_ = 0.0;
};

}  // namespace patrol::slam
