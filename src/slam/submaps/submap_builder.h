#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/messages.h"
#include "slam/graph/submap.h"
#include "slam/rbpf/trajectory_rbpf.h"
#include "slam/submaps/submap_builder_settings.h"

namespace patrol::slam {

/// Builder of one submap with a particle filter of its own [Yu23, section 1], which keeps particles and their maps
/// small. The frame `submap` is the body pose of the first scan.
class SubmapBuilder {
 public:
  SubmapBuilder(const SubmapBuilderSettings& settings, std::uint64_t seed)
      : settings_(settings), filtered_(settings.filter, seed) {}

  /// Processes a scan and returns the body pose in submap.
  Pose2 update(const LevelScan& scan, const Pose2& T_odom_body);
  bool is_full() const {
    return distance_m_ >= settings_.max_distance_m || static_cast<int>(scans_.size()) >= settings_.max_keyframes;
  }

  /// Distance traveled and sum of absolute yaw changes by odometry.
  double distance_m() const { return distance_m_; }
  double rotation_rad() const { return rotation_rad_; }

  // Estimates of the currently best particle, in submap:
  std::vector<Pose2> path() const { return filtered_.path(); }  ///< [scan]
  const GridMap& map() const { return filtered_.filter().best_map(); }
  /// Moves the scans out with their poses; no update may follow.
  std::vector<Keyframe> take_keyframes();

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(filtered_, scans_, T_odom_last_, distance_m_, rotation_rad_);
  }

 private:
  SubmapBuilderSettings settings_;
  TrajectoryRbpf filtered_;
  std::vector<LevelScan> scans_;  ///< [keyframe]
  std::optional<Pose2> T_odom_last_;
  double distance_m_ = 0.0, rotation_rad_ = 0.0;
};

}  // namespace patrol::slam
