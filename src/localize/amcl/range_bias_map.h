#pragma once

#include <map>
#include <vector>

#include <Eigen/Core>

#include "core/uwb.h"
#include "slam/mapped_range.h"

namespace patrol::localize {

/// Map of the errors of UWB ranges, by anchor and position: measured minus predicted ranges along the path of the
/// mapping. They contain the delays of the antennas, reflections and the deformation of the map. Localization on the
/// map subtracts them, so that ranges and scans agree in the pose.
class RangeBiasMap {
 public:
  RangeBiasMap() = default;
  /// The anchors are in map. Ranges of other anchors are ignored. `calibration`: bias of the predicted ranges.
  RangeBiasMap(const std::vector<slam::MappedRange>& ranges, const std::vector<UwbAnchor>& anchors_in_map,
               const UwbCalibration& calibration = {});

  /// Returns the mean error of the ranges to an anchor, m; zero without a range to it.
  double bias_m(int anchor) const;
  /// Returns the mean error of the ranges that were measured within a few meters of a position in map, m. It
  /// approaches the mean of all positions where there are few of them.
  double bias_m(int anchor, const Eigen::Vector2d& p_map) const;

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(anchors_);
  }

 private:
  struct LocalBias {
    Eigen::Vector2d p_map;
    double bias_m;
    int count;
  };
  struct AnchorBias {
    double mean_m = 0.0;
    std::vector<LocalBias> local;
  };

  std::map<int, AnchorBias> anchors_;  ///< [number]
};

}  // namespace patrol::localize
