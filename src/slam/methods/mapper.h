#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/boosted_stumps.h"
#include "core/grid.h"
#include "core/messages.h"
#include "core/pose_graph.h"
#include "core/state/state_archive_fwd.h"
#include "slam/graph/loop_closure_statistics.h"
#include "slam/graph/submap_graph.h"
#include "slam/mapped_range.h"
#include "slam/methods/mapper_settings.h"
#include "slam/position_measurement.h"
#include "slam/range_update.h"
#include "slam/slam_update.h"

namespace patrol::slam {

/// Interface of a 2D SLAM back end: online updates, plus a final optimization over all scans in `finish()`.
class Mapper {
 public:
  virtual ~Mapper() = default;

  /// Adds a UWB range measured before the next scan. Methods without range updates ignore it.
  virtual void add(const RangeMeasurement& measurement) = 0;
  /// Returns whether the method estimates the pose of the survey, whose anchors and positions it takes, in map.
  virtual bool estimates_survey() const = 0;
  /// Adds the position of an antenna, measured before the next scan. Methods without position factors ignore it.
  virtual void add(const PositionMeasurement& measurement) = 0;
  /// Processes a scan and returns the current pose in map. The origin of map is the pose of the first scan;
  /// `T_odom_body` is the odometry at the stamp of the scan. Methods without a covariance estimate leave the covariance
  /// zero.
  virtual SlamUpdate update(const LevelScan& scan, const Pose2& T_odom_body) = 0;
  /// Finishes mapping after the last scan.
  virtual void finish() = 0;

  /// Current pose estimates of all scans, [scan].
  virtual std::vector<Pose2> path() const = 0;
  virtual OccupancyGrid map() = 0;
  /// UWB ranges in line of sight along the path; empty for methods that do not keep them.
  virtual std::vector<MappedRange> mapped_ranges() const = 0;
  /// Particles at the last keyframe; empty for methods without particles.
  virtual ParticleSet particles() const = 0;
  /// Keyframes and the relative pose constraints between them. Methods without loop closure return odometry edges only.
  virtual PoseGraph graph() const = 0;
  /// Results of the searches for loop closures; none for methods that do not count them.
  virtual std::optional<LoopClosureStatistics> loop_closure_statistics() const = 0;
  /// Extends a map of earlier sessions, before the first scan. Methods that cannot do nothing and return false.
  virtual bool extend(const SubmapGraph& earlier) = 0;
  /// Whether the pose of this session in the earlier map is known; true without an earlier map.
  virtual bool is_located() const = 0;
  /// Map for later sessions, after `finish`; none for methods that cannot extend a map.
  virtual std::optional<SubmapGraph> submap_graph() const = 0;
  /// Index of the scan taken at each node, [node of the graph].
  virtual std::vector<std::size_t> node_scan_indices() const = 0;

  /// Saves or restores the state.
  virtual void serialize_state(StateArchive& archive) = 0;
};

/// Builds the method of that name. `neighbors` classifies pairs of submaps, for methods that need it.
/// Throws InputError when a setting breaks its rule.
std::unique_ptr<Mapper> make_mapper(const MapperSettings& settings, const BoostedStumps& neighbors, std::uint64_t seed);

}  // namespace patrol::slam
