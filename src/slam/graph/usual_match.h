#pragma once

#include <vector>

#include "slam/scan_matcher.h"

namespace patrol::slam {

/// Running means of the matches of a tracker, by which it recognizes a match that is worse than usual. Log likelihoods
/// are those of point_log_likelihoods() [point]: NaN in unknown cells.
class UsualMatch {
 public:
  void update(const MatchResult& match, const std::vector<double>& log_likelihoods);

  /// Returns whether as many points match surfaces as usual.
  bool has_usual_points(const MatchResult& match, const std::vector<double>& log_likelihoods) const;
  /// Returns whether the mean loss of the points in known cells is not much larger than usual.
  bool has_usual_loss(const std::vector<double>& log_likelihoods) const;
  /// Log likelihood of a point in an unknown cell. Follows from the usual fraction of points in unknown cells, which is
  /// large in a map of sparse scans.
  double unknown_log_likelihood() const;

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(matched_ratio_, loss_);
  }

 private:
  double matched_ratio_ = 0.5;  ///< fraction of points on surfaces
  double loss_ = 1.0;           ///< mean loss of a point in a known cell
};

}  // namespace patrol::slam
