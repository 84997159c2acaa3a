#pragma once

#include <cstdint>
#include <vector>

#include "core/pose_graph.h"
#include "slam/graph/scan_tracker.h"
#include "slam/filtered_path.h"

namespace patrol::slam {

/// Particles enough for a building; what tracking leaves of odometry's errors; nothing that depends on legs.
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

/// A Rao-Blackwellised particle filter (grid_slam.h) whose odometry is what matching from scan to scan makes of the wheels': the particles then have only its
/// small errors to make up for, and wheels that lie do not lead all of them astray. Plain Gmapping, with a better odometry; no loop is closed
/// but by particles that happen to have come back right.
class TrackedRbpf {
 public:
  TrackedRbpf(const TrackedRbpfSettings& settings, std::uint64_t seed);

  SlamUpdate update(const LevelScan& scan, const Pose2& T_odom_body);
  void finish() {}

  /// [scan]: of the particle that is the best now, with the whole way that it has come.
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
