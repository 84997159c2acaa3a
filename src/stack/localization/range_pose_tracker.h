#pragma once

#include <vector>

#include "core/messages.h"
#include "core/sensors/registry.h"
#include "core/uwb.h"
#include "localize/range_filter.h"

namespace patrol::stack {

/// Pose from odometry and UWB ranges alone, from the first known pose on. Independent estimate that does not influence
/// the robot.
class RangePoseTracker {
 public:
  RangePoseTracker(const localize::RangeFilterSettings& settings, const std::vector<UwbAnchor>& anchors_in_map,
                   const Pose3& T_body_uwb)
      : filter_(settings, anchors_in_map, T_body_uwb), has_anchors_(!anchors_in_map.empty()) {}

  bool has_anchors() const { return has_anchors_; }
  bool has_started() const { return filter_.has_started(); }
  void set_initial_pose(const OdometryEstimate& odometry, double height_above_ground_m, const Pose2& T_map_body,
                        const Eigen::Matrix3d& covariance) {
    filter_.set_initial_pose({.stamp = odometry.stamp, .T_map_body = T_map_body, .covariance = covariance},
                             odometry.T_odom_body, height_above_ground_m);
  }
  void set_anchors(const std::vector<UwbAnchor>& anchors_in_map) { filter_.set_anchors(anchors_in_map); }
  double height_m() const { return filter_.height_m(); }
  void add(const UwbRange& range, const Pose3& T_odom_body) { filter_.add(range, T_odom_body); }
  UwbPoseEstimate predict(const OdometryEstimate& odometry, const Eigen::Vector3d& twist_std) {
    filter_.predict(odometry.stamp, odometry.T_odom_body, twist_std);
    return {filter_.estimate(odometry.stamp, odometry.T_odom_body)};
  }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(filter_, has_anchors_);
  }

 private:
  localize::RangeFilter filter_;
  bool has_anchors_;
};

}  // namespace patrol::stack
