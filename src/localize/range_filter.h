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
  // Ranges.
  std::vector<double> bias_distance_m = UwbCalibration{}.distance_m;  ///< what a clear range reads too much,
  std::vector<double> bias_m = UwbCalibration{}.bias_m;               ///< by distance; both empty: nothing
  double range_std_m = 0.1;
  double blocked_share = 0.3;     ///< of the ranges, expected off the line of sight,
  double blocked_excess_m = 0.5;  ///< and by how much those are too long on average
  double min_clear_probability = 0.1;  ///< a long range that is less likely than this to be clear is refused
  double max_short_sigmas = 3.3;       ///< a range that is shorter than expected by more is refused: 99.9 %
  // Odometry: its errors' standard deviations come with it; here is how long they last, and what is white.
  double along_length_m = 8.0;  ///< scale, slip
  double across_length_m = 4.0;
  double turn_time_s = 300.0;  ///< bias, from one standstill to the next
  double way_std_m_per_sqrt_m = 0.003;
  double turn_std_rad_per_sqrt_s = 3.5e-4;
  double turn_std_rad_per_sqrt_rad = 0.002;
  double height_std_m_per_sqrt_m = 0.02;
  double start_height_std_m = 0.05;
  // Never locked out.
  int window = 30;                  ///< of ranges, over which refusals are counted
  double min_accepted_share = 0.4;  ///< of the window; if fewer, it is the estimate that is doubted
  double doubt_std_m = 0.5;         ///< and spread by this
  double doubt_std_rad = 0.05;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("bias_distance_m", self.bias_distance_m, between(0.0, 1000.0));
    visit("bias_m", self.bias_m, between(-10.0, 10.0));
    visit("range_std_m", self.range_std_m, between(1e-3, 10.0));
    visit("blocked_share", self.blocked_share, between(0.0, 0.99));
    visit("blocked_excess_m", self.blocked_excess_m, between(1e-3, 100.0));
    visit("min_clear_probability", self.min_clear_probability, between(0.0, 1.0));
    visit("max_short_sigmas", self.max_short_sigmas, between(0.1, 100.0));
    visit("along_length_m", self.along_length_m, between(0.01, 1e4));
    visit("across_length_m", self.across_length_m, between(0.01, 1e4));
    visit("turn_time_s", self.turn_time_s, between(0.1, 1e6));
    visit("way_std_m_per_sqrt_m", self.way_std_m_per_sqrt_m, between(0.0, 1.0));
    visit("turn_std_rad_per_sqrt_s", self.turn_std_rad_per_sqrt_s, between(0.0, 1.0));
    visit("turn_std_rad_per_sqrt_rad", self.turn_std_rad_per_sqrt_rad, between(0.0, 1.0));
    visit("height_std_m_per_sqrt_m", self.height_std_m_per_sqrt_m, between(0.0, 1.0));
    visit("start_height_std_m", self.start_height_std_m, between(0.0, 10.0));
    visit("window", self.window, between(5, 1000));
    visit("min_accepted_share", self.min_accepted_share, between(0.0, 1.0));
    visit("doubt_std_m", self.doubt_std_m, between(0.0, 100.0));
    visit("doubt_std_rad", self.doubt_std_rad, between(0.0, 3.0));
  }
};

enum class RangeVerdict : std::uint8_t {
  kAccepted,
  kTooLong,   ///< most likely off the line of sight
  kTooShort,  ///< nothing makes a range shorter: an outlier, or the estimate is wrong
  kUnusable,  ///< not finite or negative, of an anchor that nobody surveyed, heard before, frozen, or before the start
};

struct RangeOutcome {
  RangeVerdict verdict = RangeVerdict::kUnusable;
  double innovation_m = 0.0;        ///< read less expected
  double variance_m2 = 0.0;         ///< of the innovation, if the path is clear
  double clear_probability = 0.0;   ///< that it is

  bool is_accepted() const { return verdict == RangeVerdict::kAccepted; }
  /// Normalised innovation squared: chi-square of one degree of freedom over the clear ranges of a consistent filter.
  double nis() const { return variance_m2 > 0.0 ? innovation_m * innovation_m / variance_m2 : 0.0; }
};

/// Extended Kalman filter of the body in `map`: odometry's increments predict, each UWB range by itself corrects (tight coupling:
/// one range from one anchor says what it can). State: x, y, yaw; the body's height over map's origin (a tunnel is not flat, and
/// anchors hang high); and three slowly changing errors of odometry, as multiples of the standard deviations that odometry states
/// with its twist: along, across, turn. So a scale that is one percent off is learnt, and not mistaken for noise.
///
/// Ranges off the line of sight are too long, never too short. Each range is weighed by the probability that it is clear, a clear
/// one being Gaussian about what is expected and a blocked one Gaussian plus exponential (Bellusci et al. 2009; Prorok, Gonon,
/// Martinoli, "Online model estimation of ultra-wideband TDOA measurements for mobile robot localization", ICRA 2012, have the
/// like): its variance is divided by it. Least likely ones are refused. When most of the ranges of a window are refused, the
/// estimate is doubted instead, and spread until they fit again.
class RangeFilter {
 public:
  /// Throws InputError for settings out of range, tables of unlike length, or two anchors of one number.
  RangeFilter(const RangeFilterSettings& settings, const std::vector<UwbAnchor>& anchors_in_map, const Pose3& T_body_uwb);

  /// The body is there, and odometry has it at `T_odom_body`; its height is map's origin's plus `z_m`.
  void start_at(const PoseEstimate& start, const Pose3& T_odom_body, double z_m = 0.0);
  bool has_started() const { return has_started_; }

  /// Odometry has moved on; `twist_std` as TrackOdometry::twist_std. Stamps must grow; older ones are ignored.
  void predict(Time stamp, const Pose3& T_odom_body, const Eigen::Vector3d& twist_std);
  /// A range, perhaps older than the newest prediction; `T_odom_body` is where odometry had the body at its stamp.
  RangeOutcome add(const UwbRange& range, const Pose3& T_odom_body);

  /// At `stamp`, not before the newest prediction, when odometry has the body at `T_odom_body`.
  PoseEstimate estimate(Time stamp, const Pose3& T_odom_body) const;

  double height_m() const { return state_.z_m; }
  /// How often the estimate has been doubted.
  std::uint64_t doubts() const { return doubts_; }
  /// Of the last window of ranges; 1 before any.
  double accepted_share() const;

 private:
  static constexpr int kYaw = 2, kHeight = 3, kDrift = 4, kSize = 7;
  using Vector = Eigen::Matrix<double, kSize, 1>;
  struct State {
    Time stamp{};
    Pose3 T_odom_body;
    Pose2 T_map_body;
    double z_m = 0.0;
    Eigen::Vector3d drift = Eigen::Vector3d::Zero();  ///< along, across, turn; standard normal at first
    Eigen::Matrix<double, kSize, kSize> P = Eigen::Matrix<double, kSize, kSize>::Zero();
  };
  /// What was last heard from an anchor.
  struct Heard {
    Time stamp{};
    double range_m = 0.0;
    int repeats = 0;
  };
  State moved(State state, Time stamp, const Pose3& T_odom_body, const Eigen::Vector3d& twist_std) const;
  bool is_usable(const UwbRange& range);
  /// Innovation, and its gradient by the state.
  double innovation(const UwbRange& range, const Pose3& T_odom_body, Vector& H) const;
  double clear_probability(double innovation_m, double std_m) const;
  RangeVerdict judge(const RangeOutcome& outcome) const;
  void correct(const Vector& H, double innovation_m, double variance_m2);
  void count(bool is_accepted);

  RangeFilterSettings settings_;
  UwbCalibration calibration_;
  std::map<int, UwbAnchor> anchors_;
  Pose3 T_body_uwb_;

  bool has_started_ = false;
  State state_;
  Eigen::Vector3d twist_std_ = Eigen::Vector3d::Zero();
  std::map<int, Heard> heard_;
  std::deque<bool> accepted_;
  std::uint64_t doubts_ = 0;
};

}  // namespace patrol::localize
