#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/robot_description.h"
#include "core/sensors/registry.h"
#include "localize/track_encoders.h"

namespace patrol::localize {

/// Returns whether motors drive steered wheels on both sides and no wheel that is not steered.
bool is_driven_by_steered_wheels(const RobotDescription& robot);

/// Running counts of a robot with front-wheel drive: driven wheels that are steered, and wheels without motors and
/// encoders on an axle that is not steered. The counts are those of two tracks at the sides of this axle.
///
/// Between two readings, the middle of the axle moves ahead by v and turns by w. A wheel at (x, y) from it, which
/// points at the measured angle d, rolls by s without side slip:
///
///   v cos d + w (x sin d - y cos d) = s
///   -v sin d + w (x cos d + y sin d) = 0
///
/// v and w are the least squares solution for all driven wheels, with the mean angle of the two readings. The rest is a
/// motion that only slip explains, or unequal radii. Not handled: a driven wheel that lost traction, whose motion is
/// averaged with that of the others, and the motion of a wheel about a steering axis beside it.
class SteeredWheels {
 public:
  /// `ticks_per_turn`: counts per revolution of a track's sprocket with the radius of `differential_geometry`.
  /// `gauge_ratio`: effective over geometric gauge of the tracks. Throws InputError unless
  /// `is_driven_by_steered_wheels` and the driven wheels are ahead of or behind the axle.
  SteeredWheels(const RobotDescription& robot, double ticks_per_turn, double gauge_ratio);

  /// Adds an encoder reading, with finite angles of all joints, and returns the counts. They are those of the last
  /// reading for one that is not newer.
  DriveTicks add(const JointState& joints);

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(stamp_, last_rad_, left_m_, right_m_, residual_m_);
  }

 private:
  struct Wheel {
    Eigen::Vector2d p_m;  ///< from the middle of the axle, with the steering straight
    double radius_m, forward_sign, left_sign;
    std::size_t drive_joint, steering_joint;
  };

  void move(const std::vector<double>& angle_rad);

  std::vector<Wheel> wheels_;
  double half_gauge_m_, ticks_per_m_;
  std::optional<Time> stamp_;
  std::vector<double> last_rad_;  ///< last reading, [joint]
  double left_m_ = 0.0, right_m_ = 0.0, residual_m_ = 0.0;
};

}  // namespace patrol::localize
