#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "core/robot_description.h"
#include "core/sensors/registry.h"

namespace patrol::localize {

/// Running counts of wheels that are not steered, as of one track on each side.
///
/// A side counts the mean angle of its driven wheels. On uneven ground, a robot without suspension lifts wheels. A
/// lifted wheel turns at the set speed although the robot stands or slides. While the rim speeds of the wheels of a
/// side differ clearly, one wheel represents this side. It is from the pair of a left and a right wheel whose speed
/// difference fits the yaw rate of the gyro best.
///
/// Not handled: a lifted wheel that is the only driven one of its side, and a side without any traction.
class WheelRows {
 public:
  /// `ticks_per_turn`: counts per revolution of a wheel. Throws InputError for a robot without driven wheels on both
  /// sides that are not steered, or without a frame `imu`.
  WheelRows(const RobotDescription& robot, double ticks_per_turn);

  /// Adds a gyro reading; ignores one that is not finite or not newer than the last.
  void add(const Imu& imu);

  /// Adds an encoder reading, with finite angles of all joints, and returns the counts. They are those of the last
  /// reading for one that is not newer. Without a gyro reading in the last 0.1 s, a side moves by the mean angle.
  TrackTicks add(const JointState& joints);

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(left_, right_, stamp_, gyro_stamp_, yaw_rate_radps_);
  }

 private:
  struct Side {
    std::vector<std::pair<std::size_t, double>> joints;  ///< joints of the wheels: index, and sign of forward rotation
    std::vector<double> angle_rad;                       ///< last reading, [wheel]; empty before it
    std::vector<double> step_rad;                        ///< last rotation, [wheel]
    std::vector<double> speed_mps;                       ///< smoothed speed of the rim, [wheel]
    double offset_rad = 0.0;                             ///< difference between the counted and the mean angle

    template <typename Archive>
    void serialize_state(Archive& archive) {
      archive(angle_rad, step_rad, speed_mps, offset_rad);
    }
  };

  void update(Side& side, const JointState& joints, double step_s) const;
  void use_wheels_with_traction();
  std::int64_t ticks(const Side& side) const;

  Side left_, right_;
  double ticks_per_rad_, radius_m_, gauge_m_;
  Eigen::RowVector3d up_in_imu_;  ///< z axis of body
  std::optional<Time> stamp_, gyro_stamp_;
  double yaw_rate_radps_ = 0.0;  ///< smoothed
};

}  // namespace patrol::localize
