#pragma once

#include "core/messages.h"

namespace patrol::slam {

/// Detects slopes by a lidar that stays tilted while the robot drives. There, scans contain ground: it rises in front
/// of the robot, and its outline moves with the robot. The sway of a walking robot is no slope.
class UnevenGround {
 public:
  /// Adds a scan, with or without beams. `moved_m`: distance by odometry since the previous scan.
  void add(const LevelScan& scan, double moved_m);

  /// Returns whether the robot is on a slope or was on one in the last 10 m.
  bool is_near() const { return has_slope_ && since_slope_m_ < kReach_m; }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(tilted_m_, since_slope_m_, has_slope_);
  }

 private:
  /// Distance from a slope at which scans contain its ground: a lidar 0.35 m above the ground that is pitched by
  /// 0.035 rad sees the ground up to 10 m ahead.
  static constexpr double kReach_m = 10.0;

  double tilted_m_ = 0.0;       ///< distance over which all scans were tilted
  double since_slope_m_ = 0.0;  ///< distance since the last slope
  bool has_slope_ = false;      ///< whether the robot was on a slope
};

}  // namespace patrol::slam
