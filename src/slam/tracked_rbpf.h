#pragma once

#include <cstdint>
#include <vector>

#include "core/pose_graph.h"
#include "slam/graph/scan_tracker.h"
#include "slam/grid_slam.h"

namespace patrol::slam {

struct TrackedRbpfSettings {
  ScanTrackerSettings tracking;
  GridSlamSettings filter = wheeled();

  /// Particles enough for a building; what tracking leaves of odometry's errors; nothing that depends on legs.
  static GridSlamSettings wheeled() {
    GridSlamSettings settings;
    settings.max_extent_m = 2000.0;
    settings.particles = 30;
    settings.initial_keyframes = 10;
    settings.motion = {.along_std_m_per_m = 0.02,
                       .across_std_m_per_m = 0.02,
                       .turn_std_rad_per_rad = 0.02,
                       .turn_std_rad_per_m = 0.005,
                       .turn_std_rad_per_s = 0.0,
                       .min_std_m = 0.005,
                       .min_std_rad = 0.002};
    return settings;
  }

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

  Pose2 update(const LevelScan& scan, const Pose2& T_odom_body);
  void finish() {}

  /// [scan]: of the particle that is the best now, with the whole way that it has come.
  std::vector<Pose2> path() const;
  OccupancyGrid map() const { return filter_.map(); }
  PoseGraph graph() const;

 private:
  /// A scan beside the keyframe before it.
  struct TrackedPose {
    std::size_t keyframe;
    Pose2 T_keyframe_body;
  };

  ScanTracker tracker_;
  GridSlam filter_;
  std::vector<TrackedPose> path_;
  Pose2 T_local_keyframe_;
  std::size_t num_keyframes_ = 0;
};

}  // namespace patrol::slam
