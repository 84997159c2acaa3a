#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include <Eigen/Core>

#include "core/robot_description.h"
#include "core/time.h"

namespace patrol::localize {

inline constexpr int kNumLegs = 4;

/// Probability-like weight that a foot is stationary on the ground: 0 (in the air) to 1.
using ContactWeights = std::array<double, kNumLegs>;

/// Joint encoder readings of one instant, leg by leg in the order of RobotDescription::legs, with the foot contacts.
struct LegSample {
  Time stamp{};
  Eigen::Matrix<double, 3, kNumLegs> angle_rad =
      Eigen::Matrix<double, 3, kNumLegs>::Zero();  ///< columns: legs; rows: abduction, hip, knee
  Eigen::Matrix<double, 3, kNumLegs> speed_radps = Eigen::Matrix<double, 3, kNumLegs>::Zero();
  std::optional<ContactWeights> weights{};  ///< nullopt if the foot sensors have timed out
};

/// Detector of stance feet: force threshold with hysteresis. A foot counts after a settling time under load, when the
/// touch-down impact is over. Its weight is proportional to the load up to `full_weight_n`.
class ContactDetector {
 public:
  struct Settings {
    double contact_on_n;   ///< contact starts above this force
    double contact_off_n;  ///< contact ends below this force
    double full_weight_n;
    double settling_time_s;
  };
  explicit ContactDetector(const Settings& settings) : settings_(settings) {}

  /// Updates the contacts; stamps must increase.
  ContactWeights update(Time stamp, const std::array<double, kNumLegs>& force_n);

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(is_loaded_, loaded_since_);
  }

 private:
  Settings settings_;
  std::array<bool, kNumLegs> is_loaded_{};
  std::array<Time, kNumLegs> loaded_since_{};
};

/// Stance foot, relative to the trunk; in body.
struct StanceFoot {
  int leg = 0;
  Eigen::Vector3d p_contact = Eigen::Vector3d::Zero();  ///< m
  /// Velocity of the contact point of the foot relative to the trunk, from the joint rates alone, m/s.
  Eigen::Vector3d v_contact = Eigen::Vector3d::Zero();
  double weight = 1.0;  ///< contact weight, 0 to 1
};

/// Fixed-capacity list of stance feet: no allocation in the inner loop.
struct StanceFeet {
  std::array<StanceFoot, kNumLegs> feet;
  int count = 0;

  void push_back(const StanceFoot& foot) { feet[static_cast<std::size_t>(count++)] = foot; }
  StanceFoot* begin() { return feet.data(); }
  StanceFoot* end() { return feet.data() + count; }
  const StanceFoot* begin() const { return feet.data(); }
  const StanceFoot* end() const { return feet.data() + count; }
};

/// Returns the contact point of a foot and its velocity. The foot is a sphere of radius r fixed to the shank. On ground
/// with the normal n (`up_in_body`) the contact is at center - r n; while the foot rolls, this point is at rest.
/// Assuming the center to be at rest instead would lose r times the shank rotation in each step: 3 to 8 % of the
/// distance.
StanceFoot stance_foot(const LegGeometry& leg, int index, const LegSample& sample, const Eigen::Vector3d& up_in_body);

/// Velocity of the trunk from the stance feet.
struct LegVelocity {
  Eigen::Vector3d v_body = Eigen::Vector3d::Zero();     ///< velocity of the trunk origin, in body, m/s
  Eigen::Vector3d p_contact = Eigen::Vector3d::Zero();  ///< weighted mean of the contact points, in body, m
  double variance = 0.0;                                ///< variance per axis, (m/s)2
  int num_slipping = 0;                                 ///< number of down-weighted feet
};

/// Returns the weighted mean over the feet of v = -(v_contact + omega x p_contact). A foot that differs from
/// `v_expected` by more than `slip_mps` is down-weighted with the square of the difference (a Cauchy-like robust
/// weight). If one of two feet slips, the IMU prediction thus decides between them. Returns nullopt without stance
/// feet.
std::optional<LegVelocity> fuse_feet(const StanceFeet& feet, const Eigen::Vector3d& omega_body,
                                     const Eigen::Vector3d& v_expected, double foot_std_mps, double slip_mps);

/// Returns the yaw rate of the trunk from the feet alone, rad/s, by least squares over at least two feet; used when the
/// gyro has timed out.
std::optional<double> yaw_rate_from_feet(const StanceFeet& feet);

/// Returns the height of the trunk origin above the ground under the feet, along `up_in_body`, m; nullopt without
/// stance feet.
std::optional<double> height_from_feet(const StanceFeet& feet, const Eigen::Vector3d& up_in_body);

}  // namespace patrol::localize
