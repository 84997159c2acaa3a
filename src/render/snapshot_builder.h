#pragma once

#include <deque>
#include <optional>
#include <vector>

#include <mujoco/mujoco.h>

#include "core/trajectory.h"
#include "io/logs/run_log.h"
#include "render/run_snapshot.h"
#include "sim/lidar_scene.h"

namespace patrol::render {

/// Builds the snapshot of a run up to the current log message.
class SnapshotBuilder {
 public:
  /// `view` must outlive this object.
  SnapshotBuilder(const mjModel& view, const Pose2& T_world_map);

  void add(const LaserScan& scan) { scan_ = scan; }
  void add(const OdometryEstimate& odometry);
  void add(const PoseEstimate& estimate);
  void add(const ParticleSet& particles) { snapshot_.particles = particles.T_map_body; }
  void add(const MapUpdate& update) { snapshot_.map = std::make_shared<const OccupancyGrid>(update.map); }
  void add(const Path& plan);
  void add(const Event& event);
  void add(const GasReading& reading) { snapshot_.gas = reading; }
  void add(const LiningResult& result);
  void add(const GroundTruth& truth);
  void add(const SimState& state) { snapshot_.state = state; }

  const RunSnapshot& snapshot() const { return snapshot_; }
  /// Position of the robot's camera in body, none without a depth camera.
  const std::optional<Eigen::Vector3d>& head_m() const { return head_m_; }
  /// Distance to the nearest static object, at most `max_m`.
  double free_distance_m(const Eigen::Vector3d& from_m, const Eigen::Vector3d& direction, double max_m) const;

 private:
  std::vector<Eigen::Vector3d> outline_on_scenery(const Eigen::Vector3d& eye_m, const Eigen::Vector3d& p_world_m) const;
  Eigen::Vector3d on_ground(const Eigen::Vector2d& p_world_m) const;
  void transform_scan(const PoseEstimate& estimate);

  sim::LidarScene scenery_;
  Pose3 T_body_lidar_;
  std::optional<Eigen::Vector3d> head_m_;
  Trajectory truth_;
  std::deque<StampedPose> odometry_;  ///< last 2 s, T_odom_body
  std::optional<LaserScan> scan_;
  RunSnapshot snapshot_;
};

}  // namespace patrol::render
