#pragma once

#include <Eigen/Core>

#include <optional>
#include <vector>

#include "core/sensors/recorded_scan.h"
#include "core/settings.h"
#include "slam/calibration/calibration.h"
#include "slam/graph/scan_tracker.h"
#include "slam/planar_scan.h"

namespace patrol::slam {

/// A stretch of the way as the lidar and as odometry saw it.
struct MotionPair {
  Time begin{}, end{};
  std::vector<Pose2> lidar_steps;  ///< of the lidar in itself, from scan to scan, as matched
  Pose2 odometry;                  ///< of the body, as recorded, from the first scan to the last
  Eigen::Matrix3d lidar_covariance = Eigen::Matrix3d::Zero();  ///< of the steps together: x, y, yaw in the lidar at the stretch's begin

  Pose2 lidar() const {
    Pose2 whole;
    for (const Pose2& step : lidar_steps) whole = whole * step;
    return whole;
  }
};

struct MotionPairSettings {
  double stretch_m = 0.5;      ///< a stretch is full when either has moved so far
  double stretch_rad = 0.35;   ///< or turned so far
  double match_std_m = 0.002;  ///< of a match, however many points it has
  double match_std_rad = 0.0005;
  ScanTrackerSettings tracking;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("stretch_m", self.stretch_m, between(0.01, 100.0));
    visit("stretch_rad", self.stretch_rad, between(0.01, 3.0));
    visit("match_std_m", self.match_std_m, between(1e-5, 1.0));
    visit("match_std_rad", self.match_std_rad, between(1e-6, 1.0));
    visit("tracking", self.tracking);
  }
};

/// Cuts a log into stretches. The lidar is followed in its own frame by matching (scan_tracker.h), with odometry as a first guess, put right as far as
/// `known` says; how far the matches alone know each stretch is in its covariance: along a bare corridor they do not, and odometry's word, which the
/// tracker took there, counts for nothing.
class MotionPairs {
 public:
  MotionPairs(const MotionPairSettings& settings, const PlanarScanSettings& scan, const Calibration& known);

  void add(const RecordedScan& recorded);

  const std::vector<MotionPair>& pairs() const { return pairs_; }

 private:
  struct Place {
    Time stamp{};
    Pose2 T_odom_body;
    Pose2 T_local_lidar;
    Eigen::Matrix3d covariance;  ///< of T_local_lidar, in local
  };
  void begin(const Place& place);

  MotionPairSettings settings_;
  PlanarScanSettings scan_;
  CalibratedScans known_;
  ScanTracker tracker_;
  std::optional<Place> begin_;
  Pose2 T_local_last_;
  std::vector<Pose2> lidar_steps_;
  std::vector<MotionPair> pairs_;
};

}  // namespace patrol::slam
