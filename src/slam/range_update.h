#pragma once

#include <vector>

#include "core/settings.h"
#include "core/uwb.h"
#include "slam/pose_gaussian.h"

namespace patrol::slam {

struct RangeUpdateSettings {
  bool enabled = true;
  double range_std_m = 0.15;   ///< of a clear range: the radio's noise, and what the calibration leaves of its bias
  double gate_std = 3.0;       ///< a range farther off than so many standard deviations went round a corner
  double gate_excess_std = 2.0;  ///< the same for one that is too long, as those are
  UwbCalibration calibration = {};  ///< the radio's; not for the scenario

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled);
    visit("range_std_m", self.range_std_m, between(0.001, 10.0));
    visit("gate_std", self.gate_std, between(0.5, 100.0));
    visit("gate_excess_std", self.gate_excess_std, between(0.5, 100.0));
  }
};

/// A UWB range, and where the odometry had the body then.
struct RangeSighting {
  UwbAnchor anchor;  ///< in map, its height above map's ground
  double range_m = 0.0;
  Pose2 T_odom_body;
  Eigen::Vector3d p_level_antenna = Eigen::Vector3d::Zero();  ///< its height above the ground
};

/// How a range compares with what a pose predicts.
struct RangeInnovation {
  double excess_m = 0.0;  ///< measured minus predicted
  double variance_m2 = 0.0;
  Eigen::Vector3d by_pose = Eigen::Vector3d::Zero();  ///< gradient of the predicted range by x, y, yaw of the body now
};

/// `T_odom_body`: now. The way since the sighting is taken from odometry, as exact.
RangeInnovation range_innovation(const PoseGaussian& now, const Pose2& T_odom_body, const RangeSighting& sighting,
                                 const RangeUpdateSettings& settings);

/// Whether the range is that of the straight way.
bool is_plausible(const RangeInnovation& innovation, const RangeUpdateSettings& settings);

/// Corrects the pose by each range in turn (Kalman's equations); returns the log of the ranges' probability density, for a
/// particle's weight.
double update_with_ranges(const std::vector<RangeSighting>& sightings, const Pose2& T_odom_body,
                          const RangeUpdateSettings& settings, PoseGaussian& now);

}  // namespace patrol::slam
