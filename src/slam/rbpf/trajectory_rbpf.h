#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/pose_graph.h"
#include "slam/rbpf/grid_slam.h"

namespace patrol::slam {

/// Grid RBPF plus the pose of every scan relative to its keyframe.
class TrajectoryRbpf {
 public:
  TrajectoryRbpf(const GridSlamSettings& settings, std::uint64_t seed) : filter_(settings, seed) {}

  void add(const RangeMeasurement& measurement) { filter_.add(measurement); }
  SlamUpdate update(const LevelScan& scan, const Pose2& T_odom_body);
  void finish() {}

  const GridSlam& filter() const { return filter_; }
  /// Trajectory of the currently best particle, [scan].
  std::vector<Pose2> path() const;
  /// Scan index of each keyframe, [keyframe].
  const std::vector<std::size_t>& node_scan_indices() const { return keyframe_scans_; }
  OccupancyGrid map() const { return filter_.map(); }
  ParticleSet particles() const { return filter_.particles(); }
  /// Chain of keyframes; the edges have identity information.
  PoseGraph graph() const;

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(filter_, path_, T_odom_keyframe_, keyframe_scans_);
  }

 private:
  /// Pose of a scan relative to the preceding keyframe.
  struct TrackedPose {
    std::size_t keyframe = 0;
    Pose2 T_keyframe_body;
  };

  GridSlam filter_;
  std::vector<TrackedPose> path_;
  Pose2 T_odom_keyframe_;
  std::vector<std::size_t> keyframe_scans_;
};

}  // namespace patrol::slam
