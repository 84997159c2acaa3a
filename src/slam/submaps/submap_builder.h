#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/messages.h"
#include "core/settings.h"
#include "slam/filtered_path.h"
#include "slam/graph/submap.h"

namespace patrol::slam {

struct SubmapBuilderSettings {
  double max_way_m = 12.0;  ///< that the robot has come when a submap is full
  int max_keyframes = 150;  ///< or so many scans have been written
  GridSlamSettings filter = short_ways();

  /// Few particles: over a few metres they have little to make up for.
  static GridSlamSettings short_ways();

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("max_way_m", self.max_way_m, between(1.0, 1000.0));
    visit("max_keyframes", self.max_keyframes, between(2, 100000));
    visit("filter", self.filter);
  }
};

/// One submap in the making: a particle filter of its own, which ends with it (paper 002, section 1), so that particles and their maps stay small. Frame
/// `submap` is the body's where the first scan was taken.
class SubmapBuilder {
 public:
  SubmapBuilder(const SubmapBuilderSettings& settings, std::uint64_t seed) : settings_(settings), filtered_(settings.filter, seed) {}

  /// Where the body is, in submap.
  Pose2 update(const LevelScan& scan, const Pose2& T_odom_body);
  bool is_full() const { return way_m_ >= settings_.max_way_m || static_cast<int>(scans_.size()) >= settings_.max_keyframes; }

  /// By odometry, so far: all of the way, and all turns together, either way.
  double way_m() const { return way_m_; }
  double turn_rad() const { return turn_rad_; }

  // As the best particle has it by now, in submap:
  std::vector<Pose2> path() const { return filtered_.path(); }  ///< [scan]
  const GridMap& map() const { return filtered_.filter().best_map(); }
  /// Takes the scans out: none may follow.
  std::vector<Keyframe> take_keyframes();

 private:
  SubmapBuilderSettings settings_;
  FilteredPath filtered_;
  std::vector<LevelScan> scans_;  ///< [keyframe]
  std::optional<Pose2> T_odom_last_;
  double way_m_ = 0.0, turn_rad_ = 0.0;
};

}  // namespace patrol::slam
