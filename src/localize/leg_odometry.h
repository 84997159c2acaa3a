#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <optional>

#include "core/robot_description.h"
#include "core/time.h"

namespace patrol::localize {

inline constexpr int kNumLegs = 4;

/// How far each foot is to be trusted to stand still on the ground: 0 (in the air) ... 1.
using FootTrust = std::array<double, kNumLegs>;

/// Joint encoders of one instant, leg by leg in the order of RobotDescription::legs, and what the foot
/// sensors said then.
struct LegSample {
  Time stamp{};
  Eigen::Matrix<double, 3, kNumLegs> angle_rad =
      Eigen::Matrix<double, 3, kNumLegs>::Zero();  ///< column: abduction, hip, knee
  Eigen::Matrix<double, 3, kNumLegs> speed_radps = Eigen::Matrix<double, 3, kNumLegs>::Zero();
  std::optional<FootTrust> trust{};  ///< none if the foot sensors are silent
};

/// Which feet carry: force with hysteresis. A foot counts once it has been loaded for a settling time, so
/// that the impact of touch-down is over, and in proportion to its load up to `full_n`.
class ContactDetector {
 public:
  struct Settings {
    double touch_n;    ///< loaded above
    double release_n;  ///< unloaded below
    double full_n;
    double settle_s;
  };
  explicit ContactDetector(const Settings& settings) : settings_(settings) {}

  /// Stamps must grow.
  FootTrust update(Time stamp, const std::array<double, kNumLegs>& force_n);

 private:
  Settings settings_;
  std::array<bool, kNumLegs> is_loaded_{};
  std::array<Time, kNumLegs> loaded_since_{};
};

/// A foot on the ground, seen from the trunk; in body.
struct StanceFoot {
  int leg = 0;
  Eigen::Vector3d p_contact = Eigen::Vector3d::Zero();  ///< m
  /// Velocity of the point of the foot that touches the ground, relative to the trunk: what the joints alone
  /// make it, m/s.
  Eigen::Vector3d v_contact = Eigen::Vector3d::Zero();
  double weight = 1.0;  ///< trust, 0 ... 1
};

/// Fixed room for the feet on the ground: no allocation in the inner loop.
struct StanceFeet {
  std::array<StanceFoot, kNumLegs> feet;
  int count = 0;

  void push_back(const StanceFoot& foot) { feet[static_cast<std::size_t>(count++)] = foot; }
  StanceFoot* begin() { return feet.data(); }
  StanceFoot* end() { return feet.data() + count; }
  const StanceFoot* begin() const { return feet.data(); }
  const StanceFoot* end() const { return feet.data() + count; }
};

/// Where the foot touches and how that point moves. The foot is a ball of radius r fixed to the shank; on
/// ground with the normal n (`up_in_body`) it touches at its centre - r n, and while it rolls that point is
/// at rest. (Taking the centre to be at rest instead loses r times the shank's turn at each step: 3 to 8 % of
/// the way.)
StanceFoot stance_foot(const LegGeometry& leg, int index, const LegSample& sample,
                       const Eigen::Vector3d& up_in_body);

/// The trunk's velocity as the standing feet see it.
struct LegVelocity {
  Eigen::Vector3d v_body = Eigen::Vector3d::Zero();     ///< of the trunk's origin, in body, m/s
  Eigen::Vector3d p_contact = Eigen::Vector3d::Zero();  ///< weighted mean of the contacts, in body, m
  double variance = 0.0;                                ///< per axis, (m/s)2
  int num_slipping = 0;                                 ///< feet that were given little weight
};

/// Weighted mean over the feet of v = -(v_contact + omega x p_contact). A foot that disagrees with
/// `v_expected` by more than `slip_mps` loses weight with the square of its distance (a Cauchy-like weight:
/// one slipping foot of two is out-voted by what the IMU has just predicted). None if no foot stands.
std::optional<LegVelocity> fuse_feet(const StanceFeet& feet, const Eigen::Vector3d& omega_body,
                                     const Eigen::Vector3d& v_expected, double foot_std_mps, double slip_mps);

/// Yaw rate of the trunk by the feet alone, least squares over at least two; for when the gyro is silent.
/// rad/s.
std::optional<double> yaw_rate_by_feet(const StanceFeet& feet);

/// Height of the trunk's origin above the ground under the feet, along `up_in_body`, m. None if no foot
/// stands.
std::optional<double> height_by_feet(const StanceFeet& feet, const Eigen::Vector3d& up_in_body);

}  // namespace patrol::localize
