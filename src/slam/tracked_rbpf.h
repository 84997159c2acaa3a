#pragma once

#include <cstdint>
#include <vector>

#include "core/pose_graph.h"
#include "slam/graph/scan_tracker.h"
#include "slam/filtered_path.h"

namespace patrol::slam {

/// Filter settings for scan-to-scan odometry: enough particles for a building, small motion noise, no leg-specific
/// errors.
GridSlamSettings tracked_filter();

struct TrackedRbpfSettings {
  ScanTrackerSettings tracking;
  GridSlamSettings filter = tracked_filter();

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("tracking", self.tracking);
    visit("filter", self.filter);
  }
};

/// Rao-Blackwellized particle filter (grid_slam.h) on odometry from scan-to-scan matching instead of wheel odometry.
/// The particles need to represent only its small errors, and gross errors of the wheel odometry do not misplace all of
/// them. Equals Gmapping with better odometry; loops are closed only by particles that return to the correct pose.
class TrackedRbpf {
 public:
  TrackedRbpf(const TrackedRbpfSettings& settings, std::uint64_t seed);

  SlamUpdate update(const LevelScan& scan, const Pose2& T_odom_body);
  void finish() {}

  /// Trajectory of the currently best particle, [scan].
  std::vector<Pose2> path() const { return filtered_.path(); }
  OccupancyGrid map() const { return filtered_.map(); }
  ParticleSet particles() const { return filtered_.particles(); }
  PoseGraph graph() const { return filtered_.graph(); }
  std::vector<std::size_t> node_scans() const { return filtered_.node_scans(); }

 private:
  ScanTracker tracker_;
  FilteredPath filtered_;
};

}  // namespace patrol::slam
