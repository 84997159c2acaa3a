#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/sensors/recorded_scan.h"
#include "core/settings.h"
#include "slam/calibration/calibration.h"
#include "slam/graph/scan_tracker.h"
#include "slam/planar_scan.h"

namespace patrol::slam {

/// Segment of the trajectory with its lidar and odometry motion.
struct MotionSegment {
  Time begin{}, end{};
  std::vector<Pose2> lidar_steps;  ///< motion of the lidar from scan to scan, as matched
  Pose2 odometry;                  ///< recorded motion of the body from the first scan to the last
  /// Covariance of the composed lidar steps: x, y, yaw in the lidar frame at the begin of the segment.
  Eigen::Matrix3d lidar_covariance = Eigen::Matrix3d::Zero();

  Pose2 lidar() const {
    Pose2 whole;
    for (const Pose2& step : lidar_steps) whole = whole * step;
    return whole;
  }
};

struct MotionSegmentSettings {
  double length_m = 0.5;       ///< distance by lidar or odometry after which a segment ends
  double rotation_rad = 0.35;  ///< rotation by lidar or odometry after which a segment ends
  /// Standard deviation of the systematic error of a match, independent of the number of points.
  double match_std_m = 0.002;
  double match_std_rad = 0.0005;
  ScanTrackerSettings scan_odometry;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("length_m", self.length_m, between(0.01, 100.0));
    visit("rotation_rad", self.rotation_rad, between(0.01, 3.0));
    visit("match_std_m", self.match_std_m, between(1e-5, 1.0));
    visit("match_std_rad", self.match_std_rad, between(1e-6, 1.0));
    visit("scan_odometry", self.scan_odometry);
  }
};

/// Divides a log into segments. The lidar is tracked in its own frame by scan matching (scan_tracker.h), with odometry
/// as initial guess, corrected by the prior calibration `prior`. The covariance of a segment includes the matches only.
/// Along a featureless corridor it is large, so that the odometry that the tracker follows there has no weight.
class MotionSegmenter {
 public:
  MotionSegmenter(const MotionSegmentSettings& settings, const PlanarScanSettings& scan, const Calibration& prior);

  void add(const RecordedScan& recorded);

  const std::vector<MotionSegment>& pairs() const { return pairs_; }

 private:
  struct ScanPose {
    Time stamp{};
    Pose2 T_odom_body;
    Pose2 T_local_lidar;
    Eigen::Matrix3d covariance;  ///< covariance of T_local_lidar, in local
  };
  void begin(const ScanPose& scan_pose);

  MotionSegmentSettings settings_;
  PlanarScanSettings scan_;
  CalibratedScans prior_;
  ScanTracker tracker_;
  std::optional<ScanPose> begin_;
  Pose2 T_local_last_;
  std::vector<Pose2> lidar_steps_;
  std::vector<MotionSegment> pairs_;
};

}  // namespace patrol::slam
