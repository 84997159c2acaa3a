#pragma once

#include <map>
#include <vector>

#include "core/calibration/calibration_estimate.h"
#include "core/messages.h"
#include "core/sensors/registry.h"
#include "core/uwb.h"
#include "localize/calibration/anchor_delay_estimator_settings.h"
#include "localize/calibration/clustered_least_squares.h"

namespace patrol::localize {

/// UWB range with the pose of the robot at its stamp.
struct LocatedRange {
  UwbRange range;
  PoseEstimate pose;                                          ///< level body in map, by the localization
  Eigen::Vector3d p_level_antenna = Eigen::Vector3d::Zero();  ///< antenna in level; z above the origin of map
};

/// Estimator of one range delay per UWB anchor, and of the pose of map in the survey, which the delays could hide
/// otherwise. Reading = modeled reading + delay of the anchor + noise. The delay of the robot's own tag is part of
/// every anchor's delay.
class AnchorDelayEstimator {
 public:
  AnchorDelayEstimator(const AnchorDelayEstimatorSettings& settings, const std::vector<UwbAnchor>& anchors_in_map,
                       const UwbCalibration& calibration);

  /// Adds a range; unknown anchors and ranges far too long or too short are ignored.
  void add(const LocatedRange& located);

  /// Returns the delays of the anchors that have been measured.
  std::vector<CalibrationValue> delays() const;

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(anchors_, filter_);
  }

 private:
  struct Anchor {
    UwbAnchor anchor;
    Eigen::Index parameter;
    int num_ranges = 0;
  };

  AnchorDelayEstimatorSettings settings_;
  UwbCalibration calibration_;
  std::map<int, Anchor> anchors_;  ///< anchors by number
  ClusteredLeastSquares filter_;   ///< x, y, yaw of map in the survey; then the delays
};

}  // namespace patrol::localize
