#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/pose_graph.h"
#include "slam/grid_slam.h"

namespace patrol::slam {

/// A particle filter on grids, and where it believes now that every scan was taken.
class FilteredPath {
 public:
  FilteredPath(const GridSlamSettings& settings, std::uint64_t seed) : filter_(settings, seed) {}

  void add(const RangeSighting& sighting) { filter_.add(sighting); }
  SlamUpdate update(const LevelScan& scan, const Pose2& T_odom_body);
  void finish() {}

  const GridSlam& filter() const { return filter_; }
  /// [scan]: of the particle that is the best now, with the whole way that it has come.
  std::vector<Pose2> path() const;
  /// [keyframe]: the number of its scan.
  const std::vector<std::size_t>& node_scans() const { return keyframe_scans_; }
  OccupancyGrid map() const { return filter_.map(); }
  ParticleSet particles() const { return filter_.particles(); }
  /// Keyframes, one after the other; nothing weighs the edges.
  PoseGraph graph() const;

 private:
  /// A scan beside the keyframe before it.
  struct TrackedPose {
    std::size_t keyframe;
    Pose2 T_keyframe_body;
  };

  GridSlam filter_;
  std::vector<TrackedPose> path_;
  Pose2 T_odom_keyframe_;
  std::vector<std::size_t> keyframe_scans_;
};

}  // namespace patrol::slam
