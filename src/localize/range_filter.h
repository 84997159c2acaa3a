#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <vector>

#include <Eigen/Core>

#include "core/messages.h"
#include "core/sensors/registry.h"
#include "core/uwb.h"
#include "localize/range_filter_settings.h"

namespace patrol::localize {

enum class RangeStatus : std::uint8_t {
  kAccepted,
  kTooLong,   ///< probably NLOS
  kTooShort,  ///< outlier or wrong estimate, because no effect shortens a range
  kUnusable,  ///< value not finite or negative, unknown anchor, old stamp, frozen, or before the start
};

struct RangeOutcome {
  RangeStatus status = RangeStatus::kUnusable;
  double innovation_m = 0.0;     ///< measured minus predicted range
  double variance_m2 = 0.0;      ///< variance of the innovation of a line-of-sight range
  double los_probability = 0.0;  ///< posterior probability of line of sight

  bool is_accepted() const { return status == RangeStatus::kAccepted; }
  /// Returns the normalized innovation squared: chi-square with one degree of freedom over the line-of-sight ranges of
  /// a consistent filter.
  double nis() const { return variance_m2 > 0.0 ? innovation_m * innovation_m / variance_m2 : 0.0; }
};

/// Extended Kalman filter of the body pose in `map`: predicted with odometry increments, corrected with single UWB
/// ranges (tight coupling). State: x, y, yaw; height of the body above the origin of map (tunnels are not level, and
/// anchors are mounted high); and three slowly varying odometry errors. These errors are longitudinal, lateral and yaw,
/// in multiples of the standard deviations that odometry reports for its twist. Thus a scale error of one percent is
/// estimated and not treated as noise.
///
/// NLOS ranges are too long, never too short. The model of a line-of-sight innovation is a Gaussian, that of an NLOS
/// innovation a Gaussian plus an exponential variable, similar to [Bellusci09] and [Prorok12]. The variance of each
/// range is divided by its line-of-sight probability; the least probable ranges are rejected. If most ranges of a
/// window are rejected, the covariance is inflated until ranges are accepted again.
class RangeFilter {
 public:
  /// Creates the filter. Throws InputError for settings out of range, bias tables of different lengths, or duplicate
  /// anchor numbers.
  RangeFilter(const RangeFilterSettings& settings, const std::vector<UwbAnchor>& anchors_in_map, Pose3 T_body_uwb);

  /// Moves the anchors in map. Throws InputError for duplicate numbers.
  void set_anchors(const std::vector<UwbAnchor>& anchors_in_map);

  /// Starts at a pose, at which the odometry pose is `T_odom_body`; the height above the origin of map is `z_m`.
  void set_initial_pose(const PoseEstimate& start, const Pose3& T_odom_body, double z_m = 0.0);
  bool has_started() const { return has_started_; }

  /// Predicts with a new odometry pose; `twist_std` as in TrackOdometry::twist_std. Stamps must increase; older ones
  /// are ignored.
  void predict(Time stamp, const Pose3& T_odom_body, const Eigen::Vector3d& twist_std);
  /// Corrects with a range, possibly older than the newest prediction. `T_odom_body`: odometry pose at the stamp of the
  /// range.
  RangeOutcome add(const UwbRange& range, const Pose3& T_odom_body);

  /// Returns the estimate at `stamp`, not before the newest prediction, for the odometry pose `T_odom_body`.
  PoseEstimate estimate(Time stamp, const Pose3& T_odom_body) const;

  double height_m() const { return state_.z_m; }
  /// Returns how many times the covariance was inflated after too many rejections.
  std::uint64_t num_resets() const { return num_resets_; }
  /// Returns the acceptance ratio over the last window of ranges; 1 before the first range.
  double accepted_ratio() const;

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(anchors_, has_started_, state_, twist_std_, last_ranges_, accepted_, num_resets_);
  }

 private:
  static constexpr int kYaw = 2, kHeight = 3, kDrift = 4, kSize = 7;
  using Vector = Eigen::Matrix<double, kSize, 1>;
  struct State {
    Time stamp{};
    Pose3 T_odom_body;
    Pose2 T_map_body;
    double z_m = 0.0;
    Eigen::Vector3d drift = Eigen::Vector3d::Zero();  ///< longitudinal, lateral, yaw; prior standard normal
    Eigen::Matrix<double, kSize, kSize> P = Eigen::Matrix<double, kSize, kSize>::Zero();
  };
  /// Most recent range of an anchor.
  struct LastRange {
    Time stamp{};
    double range_m = 0.0;
    int repeats = 0;
  };
  State predicted(State state, Time stamp, const Pose3& T_odom_body, const Eigen::Vector3d& twist_std) const;
  bool is_usable(const UwbRange& range);
  /// Returns the innovation and its gradient with respect to the state.
  double innovation(const UwbRange& range, const Pose3& T_odom_body, Vector& H) const;
  double los_probability(double innovation_m, double std_m) const;
  RangeStatus classify(const RangeOutcome& outcome) const;
  void correct(const Vector& H, double innovation_m, double variance_m2);
  void count(bool is_accepted);

  RangeFilterSettings settings_;
  UwbCalibration calibration_;
  std::map<int, UwbAnchor> anchors_;
  Pose3 T_body_uwb_;

  bool has_started_ = false;
  State state_;
  Eigen::Vector3d twist_std_ = Eigen::Vector3d::Zero();
  std::map<int, LastRange> last_ranges_;
  std::deque<bool> accepted_;
  std::uint64_t num_resets_ = 0;
};

}  // namespace patrol::localize
