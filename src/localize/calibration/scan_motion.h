#pragma once

#include <optional>

#include <Eigen/Core>

#include "core/messages.h"
#include "localize/calibration/scan_motion_settings.h"
#include "slam/grid_map.h"

namespace patrol::localize {

/// Pose of a scan in a local map.
struct MatchedScan {
  int map = 0;  ///< number of the local map; poses in different maps are not comparable
  Pose2 T_local_level;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< covariance of the match alone, in local; 10 m and 10 rad
                                                         ///< along directions that the scan leaves degenerate
};

/// Motion of the lidar by scan matching, as independent of odometry as the scans allow: odometry gives the start of the
/// search and a weak prior only. Each scan is matched with a local map of a few meters.
class ScanMotion {
 public:
  explicit ScanMotion(const ScanMotionSettings& settings);

  /// Returns the matched pose; none for the first scan of a local map and for scans that do not match.
  std::optional<MatchedScan> add(const LevelScan& scan, const Pose2& T_odom_level);

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(map_, map_number_, T_odom_last_, T_local_last_, T_local_keyframe_, length_m_);
  }

 private:
  void begin_map(const LevelScan& scan);
  void integrate(const LevelScan& scan);

  ScanMotionSettings settings_;
  std::optional<slam::GridMap> map_;
  int map_number_ = 0;
  Pose2 T_odom_last_, T_local_last_, T_local_keyframe_;
  double length_m_ = 0.0;  ///< distance traveled in the local map
};

}  // namespace patrol::localize
