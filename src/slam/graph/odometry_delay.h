#pragma once

#include <array>
#include <vector>

#include "core/frames.h"
#include "core/time.h"

namespace patrol::slam {

/// Online estimation of the time offset between scans and odometry, for scans whose stamps are late, for example times
/// of reception: odometry with the stamp of such a scan is ahead of it. The yaw changes of the tracked scans are
/// compared with those of odometry at offsets of up to 0.4 s both ways. An offset is used only if it explains the yaw
/// changes clearly better than none and its opposite does not: interpolated odometry is smoother, which alone reduces
/// the differences at both.
///
/// Scans ahead of odometry are not compensated, because odometry at their time is not known yet.
class OdometryDelay {
 public:
  /// Adds odometry at the stamp of a scan and returns odometry at the time at which the scan was measured. Continuous:
  /// a new estimate of the offset changes the following increments only. Unchanged until an offset is found.
  Pose2 compensated(Time stamp, const Pose2& T_odom_body);
  /// Adds the tracked yaw of that scan, rad.
  void update(double yaw_rad);

  double scan_delay_s() const { return scan_delay_s_; }  ///< delay of the scans relative to their stamps; 0: none found

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(readings_, evaluated_, scan_delay_s_, differences_, turned_rad_, T_continuous_odom_);
  }

 private:
  static constexpr int kMaxSteps = 20;  ///< tried offsets each way
  static constexpr std::size_t kOffsets = 2 * kMaxSteps + 1;

  struct Reading {
    Time stamp{};
    Pose2 T_odom_body;
    double odometry_yaw_rad = 0.0;  ///< yaw of odometry without wrapping
    double tracked_yaw_rad = 0.0;   ///< tracked yaw without wrapping
  };

  Reading odometry_at(Time stamp) const;
  void evaluate(std::size_t reading);
  void choose_offset();

  std::vector<Reading> readings_;  ///< newest last
  std::size_t evaluated_ = 0;      ///< readings whose yaw changes have been compared
  double scan_delay_s_ = 0.0;
  std::array<double, kOffsets> differences_{};  ///< sums of the differences of yaw changes, rad, [offset]
  double turned_rad_ = 0.0;                     ///< sum of the compared yaw changes
  Pose2 T_continuous_odom_;
};

}  // namespace patrol::slam
