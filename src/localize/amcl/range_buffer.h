#pragma once

#include <map>
#include <vector>

#include <Eigen/Core>

#include "core/frames.h"
#include "core/sensors/registry.h"
#include "core/uwb.h"
#include "localize/amcl/range_likelihood.h"

namespace patrol::localize {

/// Buffer of the newest range of each anchor, with the odometry pose at its time.
class RangeBuffer {
 public:
  /// Anchors in map, with heights above the body origin. `calibration`: bias of the line-of-sight ranges.
  RangeBuffer(const std::vector<UwbAnchor>& anchors_in_map, Pose3 T_body_uwb, UwbCalibration calibration = {});

  void set_anchors(const std::vector<UwbAnchor>& anchors_in_map);
  /// Adds a range. Ranges of unknown anchors and ranges that are not finite and positive are ignored.
  void add(const UwbRange& range, const Pose3& T_odom_body);
  /// Returns the ranges newer than `since` in the body frame at `T_odom_now`, sorted by anchor number.
  std::vector<AnchoredRange> ranges_since(Time since, const Pose2& T_odom_now) const;

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(p_map_anchor_, newest_);
  }

 private:
  struct BufferedRange {
    Time stamp{};
    Pose2 T_odom_body;
    Eigen::Vector3d p_level_antenna = Eigen::Vector3d::Zero();
    double distance_m = 0.0;  ///< measured range minus the LOS bias
  };

  std::map<int, Eigen::Vector3d> p_map_anchor_;
  Pose3 T_body_uwb_;
  UwbCalibration calibration_;
  std::map<int, BufferedRange> newest_;
};

}  // namespace patrol::localize
