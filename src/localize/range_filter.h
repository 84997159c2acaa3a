#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <deque>
#include <map>
#include <vector>

#include "core/messages.h"
#include "core/sensors/registry.h"
#include "core/settings.h"
#include "core/uwb.h"

namespace patrol::localize {

struct RangeFilterSettings {
  // UWB ranges.
  /// Bias of a line-of-sight range at each distance of `bias_distance_m`.
  std::vector<double> bias_distance_m = UwbCalibration{}.distance_m;
  std::vector<double> bias_m = UwbCalibration{}.bias_m;               ///< both lists empty: no bias
  double range_std_m = 0.1;
  double nlos_probability = 0.3;     ///< prior probability of a non-line-of-sight (NLOS) range
  double nlos_bias_m = 0.5;  ///< mean bias of NLOS ranges
  /// Ranges that are too long and have a smaller line-of-sight probability are rejected.
  double min_los_probability = 0.1;
  double negative_gate_sigma = 3.3;       ///< ranges that are too short by more standard deviations are rejected: 99.9 %
  // Odometry. The standard deviations of its errors are part of its output; here are their correlation lengths and
  // white noise.
  double longitudinal_correlation_m = 8.0;  ///< scale, slip
  double lateral_correlation_m = 4.0;
  double yaw_correlation_s = 300.0;  ///< gyro bias, from one standstill to the next
  double position_random_walk_m_per_sqrt_m = 0.003;
  double yaw_random_walk_rad_per_sqrt_s = 3.5e-4;
  double yaw_random_walk_rad_per_sqrt_rad = 0.002;
  double height_std_m_per_sqrt_m = 0.02;
  double start_height_std_m = 0.05;
  // Recovery from a wrong estimate.
  int window = 30;                  ///< number of ranges over which rejections are counted
  double min_accepted_ratio = 0.4;  ///< minimum acceptance ratio of the window; below it the covariance is inflated
  double reset_std_m = 0.5;         ///< standard deviation added to x and y
  double reset_std_rad = 0.05;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("bias_distance_m", self.bias_distance_m, between(0.0, 1000.0));
    visit("bias_m", self.bias_m, between(-10.0, 10.0));
    visit("range_std_m", self.range_std_m, between(1e-3, 10.0));
    visit("nlos_probability", self.nlos_probability, between(0.0, 0.99));
    visit("nlos_bias_m", self.nlos_bias_m, between(1e-3, 100.0));
    visit("min_los_probability", self.min_los_probability, between(0.0, 1.0));
    visit("negative_gate_sigma", self.negative_gate_sigma, between(0.1, 100.0));
    visit("longitudinal_correlation_m", self.longitudinal_correlation_m, between(0.01, 1e4));
    visit("lateral_correlation_m", self.lateral_correlation_m, between(0.01, 1e4));
    visit("yaw_correlation_s", self.yaw_correlation_s, between(0.1, 1e6));
    visit("position_random_walk_m_per_sqrt_m", self.position_random_walk_m_per_sqrt_m, between(0.0, 1.0));
    visit("yaw_random_walk_rad_per_sqrt_s", self.yaw_random_walk_rad_per_sqrt_s, between(0.0, 1.0));
    visit("yaw_random_walk_rad_per_sqrt_rad", self.yaw_random_walk_rad_per_sqrt_rad, between(0.0, 1.0));
    visit("height_std_m_per_sqrt_m", self.height_std_m_per_sqrt_m, between(0.0, 1.0));
    visit("start_height_std_m", self.start_height_std_m, between(0.0, 10.0));
    visit("window", self.window, between(5, 1000));
    visit("min_accepted_ratio", self.min_accepted_ratio, between(0.0, 1.0));
    visit("reset_std_m", self.reset_std_m, between(0.0, 100.0));
    visit("reset_std_rad", self.reset_std_rad, between(0.0, 3.0));
  }
};

enum class RangeStatus : std::uint8_t {
  kAccepted,
  kTooLong,   ///< probably NLOS
  kTooShort,  ///< outlier or wrong estimate, because no effect shortens a range
  kUnusable,  ///< not finite, negative, unknown anchor, old stamp, frozen, or before the start
};

struct RangeOutcome {
  RangeStatus status = RangeStatus::kUnusable;
  double innovation_m = 0.0;        ///< measured minus predicted range
  double variance_m2 = 0.0;         ///< variance of the innovation of a line-of-sight range
  double los_probability = 0.0;   ///< posterior probability of line of sight

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
  RangeFilter(const RangeFilterSettings& settings, const std::vector<UwbAnchor>& anchors_in_map, const Pose3& T_body_uwb);

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
