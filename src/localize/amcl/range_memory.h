#pragma once

#include <Eigen/Core>

#include <map>
#include <vector>

#include "core/frames.h"
#include "core/sensors/registry.h"
#include "core/uwb.h"
#include "localize/amcl/range_likelihood.h"

namespace patrol::localize {

/// The newest range of each anchor, and where odometry had the body when it was taken.
class RangeMemory {
 public:
  /// Anchors in map, heights above the body's origin.
  RangeMemory(const std::vector<UwbAnchor>& anchors_in_map, const Pose3& T_body_uwb);

  /// Ranges of anchors that the survey does not know are ignored, and those that are not finite and positive.
  void add(const UwbRange& range, const Pose3& T_odom_body);
  /// Those taken after `since`, as seen from the body when odometry has it at `T_odom_now`; by number of the anchor.
  std::vector<AnchoredRange> taken_after(Time since, const Pose2& T_odom_now) const;

 private:
  struct Heard {
    Time stamp{};
    Pose2 T_odom_body;
    Eigen::Vector3d p_level_antenna = Eigen::Vector3d::Zero();
    double distance_m = 0.0;  ///< what was read, less what a clear range reads too much
  };

  std::map<int, Eigen::Vector3d> p_map_anchor_;
  Pose3 T_body_uwb_;
  UwbCalibration calibration_;
  std::map<int, Heard> newest_;
};

}  // namespace patrol::localize
