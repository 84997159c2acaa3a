#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/pose_graph.h"
#include "slam/graph/scan_tracker.h"
#include "slam/rbpf/scan_odometry_rbpf_settings.h"
#include "slam/rbpf/trajectory_rbpf.h"

namespace patrol::slam {

/// Rao-Blackwellized particle filter on grids (grid_slam.h), the method `rbpf` of runs and of recorded logs. Gmapping's
/// filter; loops are closed only by particles that return to the right pose.
///
/// With `odometry: scan_matched`, matching from scan to scan corrects the odometry before the filter uses it: the
/// particles have only its small errors to correct, and wrong wheel odometry does not mislead all of them.
class ScanOdometryRbpf {
 public:
  ScanOdometryRbpf(const ScanOdometryRbpfSettings& settings, std::uint64_t seed);

  /// A range between scans; left out before the first scan.
  void add(RangeMeasurement measurement);
  SlamUpdate update(const LevelScan& scan, const Pose2& T_odom_body);
  void finish() {}

  /// Trajectory of the currently best particle, [scan].
  std::vector<Pose2> path() const { return filtered_.path(); }
  OccupancyGrid map() const { return filtered_.map(); }
  ParticleSet particles() const { return filtered_.particles(); }
  PoseGraph graph() const { return filtered_.graph(); }
  std::vector<std::size_t> node_scan_indices() const { return filtered_.node_scan_indices(); }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive.part(tracker_);
    archive(newest_, filtered_);
  }

 private:
  /// Poses of the newest scan in the given and in the corrected odometry.
  struct OdometryPair {
    Pose2 T_odom_body, T_local_body;
  };

  std::optional<ScanTracker> tracker_;  ///< none with `odometry: given`
  std::optional<OdometryPair> newest_;  ///< poses of the newest scan; none without a tracker
  TrajectoryRbpf filtered_;
};

}  // namespace patrol::slam
