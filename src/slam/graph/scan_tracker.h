#pragma once

#include <optional>
#include <vector>

#include "core/messages.h"
#include "core/settings.h"
#include "slam/motion_model.h"
#include "slam/scan_integration.h"
#include "slam/scan_matcher.h"

namespace patrol::slam {

struct ScanTrackerSettings {
  double resolution_m = 0.05;
  double max_extent_m = 4000.0;          ///< nothing is kept farther than half of this from the start
  double keyframe_distance_m = 0.25;
  double keyframe_angle_rad = 0.15;
  int initial_keyframes = 10;            ///< so many first scans are all written
  int submap_keyframes = 60;             ///< that are written into a map before the next takes its place; maps overlap by half
  double likelihood_gain = 0.2;          ///< share of the points that err independently
  MotionModelSettings motion{.along_std_m_per_m = 0.05,
                             .across_std_m_per_m = 0.03,
                             .turn_std_rad_per_rad = 0.1,
                             .turn_std_rad_per_m = 0.03,
                             .turn_std_rad_per_s = 0.003,
                             .min_std_m = 0.005,
                             .min_std_rad = 0.005};  ///< of wheels that nobody calibrated
  ScanMatcherSettings matching;
  ScanIntegrationSettings integration;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("resolution_m", self.resolution_m, between(0.01, 1.0));
    visit("max_extent_m", self.max_extent_m, between(1.0, 20000.0));
    visit("keyframe_distance_m", self.keyframe_distance_m, between(0.0, 10.0));
    visit("keyframe_angle_rad", self.keyframe_angle_rad, between(0.0, 3.2));
    visit("initial_keyframes", self.initial_keyframes, between(1, 1000));
    visit("submap_keyframes", self.submap_keyframes, between(4, 10000));
    visit("likelihood_gain", self.likelihood_gain, between(0.0, 1.0));
    visit("motion", self.motion);
    visit("matching", self.matching);
    visit("integration", self.integration);
  }
};

struct TrackedScan {
  Pose2 T_local_body;
  Eigen::Matrix3d match_information = Eigen::Matrix3d::Zero();  ///< of the scan alone, in `local`; zero: no match
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();         ///< of odometry since the last match, with this one; in `local`
  double matched_share = 0.0;
  bool is_keyframe = false;
  int submap = 0;                ///< that it was matched with: 0, 1, ...; a keyframe is part of it, the last one too, with which the next takes its place
  bool is_submap_start = false;  ///< a keyframe that is the first of a new map
};

/// Follows the robot from scan to scan by matching against a map of the last metres: locally true, and drifting with the way
/// (the local half of Hess et al., "Real-time loop closure in 2D lidar SLAM", ICRA 2016). `local` begins where the first scan was taken.
///
/// Two maps are written at a time, the second begun when the first is half full; scans are matched with the older, so that there is always one
/// of half the length or more.
///
/// Old wheels lie: odometry may slip, stand still or say forwards for backwards. It is believed as far as its Gaussian goes and no farther: where the
/// motion of a moment ago, none, the opposite, or a search all round, explains the scan so much better that odometry must have failed, that is taken.
class ScanTracker {
 public:
  explicit ScanTracker(const ScanTrackerSettings& settings);

  TrackedScan update(const LevelScan& scan, const Pose2& T_odom_body);

 private:
  struct Hypothesis {
    Pose2 T_local_body;
    std::optional<MatchResult> match;
    double log_prior = 0.0;
    std::vector<double> log_likelihoods = {};  ///< [point]
  };

  /// Where odometry is carried on from.
  struct Fix {
    Time stamp{};
    Pose2 T_local_body, T_odom_body;
  };

  /// From the scan before to this one, as odometry has it.
  struct Step {
    double seconds = 0.0;
    Pose2 T_last_odom;
  };

  Hypothesis follow(const std::vector<MatchPoint>& points, const Step& step, const PoseGaussian& prediction) const;
  void doubt_odometry(const PoseGaussian& prediction, const Pose2& T_local_body);
  TrackedScan believed(const Hypothesis& best, const PoseGaussian& prediction) const;
  bool is_keyframe_due(const Pose2& T_local_body) const;
  bool is_better(const Hypothesis& a, const Hypothesis& b) const;
  Hypothesis try_from(const Pose2& T_local_start, const std::vector<MatchPoint>& points, const PoseGaussian& prediction, bool is_odometry) const;
  void write(const LevelScan& scan, const Pose2& T_local_body, TrackedScan& tracked);

  ScanTrackerSettings settings_;
  GridMap older_, newer_;
  int older_keyframes_ = 0, newer_keyframes_ = 0, keyframes_ = 0, submap_ = 0;
  std::optional<Time> stamp_;
  Pose2 T_local_last_, T_odom_last_, T_local_keyframe_;
  Fix matched_;       ///< the last scan that was matched
  Pose2 T_last_now_;  ///< the motion from the scan before to the last
  double last_step_s_ = 0.0;
  double odometry_doubt_ = 1.0;  ///< factor of its variance
};

}  // namespace patrol::slam
