#pragma once

#include <deque>
#include <optional>

#include "core/frames.h"
#include "core/time.h"

namespace patrol::io {

/// Whether a gyro would make odometry turn otherwise.
enum class GyroVerdict {
  kUnknown,      ///< there is none, or too few turns were seen
  kAgrees,       ///< odometry turns as the gyro does: it is in it already, or not needed
  kContradicts,  ///< odometry has a scale of its own, or slips
  kUnrelated,    ///< the two have little in common: another axis, another robot
};

/// Odometry whose turns are those of a gyro. What the wheels say of the way is kept: from one scan to the next it is turned by half of what the turn differs.
///
/// The gyro's bias is its mean while odometry says that the robot stands (a second or more at a time, from all such times so far); while it stands it does
/// not turn. Before the first such time the bias is that of an earlier look at the log, or is taken as none. A stretch that the gyro's messages do not cover keeps odometry's turn.
class GyroOdometry {
 public:
  explicit GyroOdometry(std::optional<double> earlier_bias_radps = {}) : earlier_bias_radps_(earlier_bias_radps) {}

  /// About the body's z axis. Stamps that do not grow are dropped.
  void add(Time stamp, double yaw_rate_radps);

  /// By growing stamp, one for each scan; begins where odometry has the first.
  Pose2 fuse(Time stamp, const Pose2& T_odom_body);

  /// A motion of odometry's in between, with the gyro's turn: that of a scan from its first beam to its last.
  Pose2 turned(const Pose2& motion, Time begin, Time end) const;

  GyroVerdict verdict() const;
  std::optional<double> bias_radps() const;
  double standing_s() const { return standing_s_; }
  double way_without_bias_s() const { return without_bias_s_; }  ///< that the robot moved before anything was known of it
  double uncovered_s() const { return uncovered_s_; }            ///< that the gyro's messages do not cover

 private:
  struct Heading {
    Time stamp{};
    double yaw_rad = 0.0;  ///< integrated as measured, not wrapped
  };
  std::optional<double> heading_at(Time stamp) const;
  double turn_of_step(const Pose2& step, double dt_s, std::optional<double> gyro_rad);
  void compare(double odometry_rad, double gyro_rad, double dt_s);

  std::optional<double> earlier_bias_radps_;
  std::deque<Heading> headings_;  ///< by growing stamp, without gaps
  double last_rate_radps_ = 0.0;
  std::optional<Time> last_stamp_;  ///< of the scan before
  std::optional<double> last_heading_rad_;
  Pose2 T_odom_last_, T_fused_last_;
  double standstill_s_ = 0.0;                     ///< that is going on
  double pending_s_ = 0.0, pending_rad_ = 0.0;    ///< of it, until it is long enough to be one
  double standing_s_ = 0.0, standing_rad_ = 0.0;  ///< of all that were
  double without_bias_s_ = 0.0, uncovered_s_ = 0.0;
  /// Sums for odometry = slope * gyro + offset * time.
  double gg_ = 0.0, gt_ = 0.0, tt_ = 0.0, og_ = 0.0, ot_ = 0.0, oo_ = 0.0;
};

}  // namespace patrol::io
