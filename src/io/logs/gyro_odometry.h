#pragma once

#include <deque>
#include <optional>

#include "core/frames.h"
#include "core/time.h"

namespace patrol::io {

/// Result of the consistency test between gyro and odometry.
enum class GyroConsistency {
  kUnknown,      ///< no gyro, or not enough rotation for a decision
  kAgrees,       ///< odometry rotates as the gyro does: the gyro is already fused, or is not needed
  kContradicts,  ///< odometry has a rotation scale error, or slips
  kUnrelated,    ///< low correlation: wrong axis or other robot
};

/// Gyro-aided odometry: yaw increments from the gyro, translation from the wheel odometry. Each translation increment
/// is rotated by half of the yaw correction (midpoint rule).
///
/// The gyro bias is the mean rate over all standstills of at least one second so far, which odometry detects. Before
/// the first standstill the bias is the given value from an earlier pass over the log, or zero. Standstills and
/// intervals without gyro messages keep the yaw increment of the odometry.
class GyroOdometry {
 public:
  explicit GyroOdometry(std::optional<double> earlier_bias_radps = {}) : earlier_bias_radps_(earlier_bias_radps) {}

  /// Adds a yaw rate about the z axis of the body. Messages whose stamp does not increase are dropped.
  void add(Time stamp, double yaw_rate_radps);

  /// Returns the fused pose at a scan. Call once per scan with increasing stamps. The first fused pose equals that of
  /// the odometry.
  Pose2 fuse(Time stamp, const Pose2& T_odom_body);

  /// Returns an odometry motion with its yaw increment replaced by that of the gyro, for example the motion during one
  /// scan.
  Pose2 replace_rotation(const Pose2& motion, Time begin, Time end) const;

  GyroConsistency consistency() const;
  std::optional<double> bias_radps() const;
  double stationary_s() const { return stationary_s_; }
  double motion_without_bias_s() const { return without_bias_s_; }  ///< duration of motion before a bias was available
  double uncovered_s() const { return uncovered_s_; }               ///< duration without gyro messages

 private:
  struct Heading {
    Time stamp{};
    double yaw_rad = 0.0;  ///< integrated raw rate, not wrapped
  };
  std::optional<double> heading_at(Time stamp) const;
  double fused_yaw(const Pose2& step, double dt_s, std::optional<double> gyro_rad);
  void compare(double odometry_rad, double gyro_rad, double dt_s);

  std::optional<double> earlier_bias_radps_;
  std::deque<Heading> headings_;  ///< headings by increasing stamp, without gaps
  double last_rate_radps_ = 0.0;
  std::optional<Time> last_stamp_;  ///< stamp of the previous scan
  std::optional<double> last_heading_rad_;
  Pose2 T_odom_last_, T_fused_last_;
  double standstill_s_ = 0.0;                         ///< duration of the current standstill
  double pending_s_ = 0.0, pending_rad_ = 0.0;        ///< part of the current standstill that is not yet in the bias
  double stationary_s_ = 0.0, stationary_rad_ = 0.0;  ///< sums over all standstills, for the bias
  double without_bias_s_ = 0.0, uncovered_s_ = 0.0;
  /// Sums for the least-squares fit odometry = slope * gyro + offset * time.
  double gg_ = 0.0, gt_ = 0.0, tt_ = 0.0, og_ = 0.0, ot_ = 0.0, oo_ = 0.0;
};

}  // namespace patrol::io
