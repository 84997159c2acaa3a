#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/frames.h"
#include "core/messages.h"
#include "core/robot_description.h"
#include "core/sensors/registry.h"
#include "sim/locomotion/wheel_drive.h"
#include "sim/model_assembly.h"
#include "sim/sensors/imu.h"
#include "sim/sensors/joint_encoders.h"

namespace patrol::sim {

inline const std::string kWheeledUrdf = PATROL_SOURCE_DIR "/models/wheeled/wheeled.urdf";

/// Result of a drive on wheels, by ground truth.
struct WheelReport {
  Pose2 moved;          ///< end in the frame of the start; the yaw is unwrapped
  double left_m = 0.0;  ///< mean travel of the driven wheels of a side by their joints and nominal radii
  double right_m = 0.0;
  double max_tilt_rad = 0.0;
  double max_abs_torque_nm = 0.0;  ///< maximum torque of any motor
  double mean_torque_nm = 0.0;     ///< mean torque of all motors whose axes point to the left
};

/// A wheeled robot of a URDF file in a world of its own, with its firmware and noisy IMU.
class WheeledRobot {
 public:
  /// `world` is MJCF. The robot has settled when this returns.
  explicit WheeledRobot(const std::string& world, const std::string& urdf_text, const WheelDriveSettings& settings = {},
                        const WheelErrors& errors = {}, const Pose2& T_world_start = {});

  WheelReport drive(double vx_mps, double yaw_rate_radps, double duration_s, double vy_mps = 0.0);
  /// Advances without firmware: motors off and brakes open.
  void roll(double duration_s);
  /// Sets the velocity of the robot along its x axis, with all wheels rolling.
  void push(double speed_mps);
  /// Sets the velocity of the robot in the plane, in body; the wheels turn at `wheel_radps` [wheel].
  void push(const Eigen::Vector2d& velocity_mps, const std::vector<double>& wheel_radps);
  /// Opens the brakes with a short motion.
  void open_brakes() { drive(0.1, 0.0, 0.2); }
  /// Locks all wheels.
  void lock_wheels();

  Pose3 T_world_body() const;
  double speed_mps() const { return velocity_mps().x(); }
  /// Returns the velocity of the body origin in body.
  Eigen::Vector3d velocity_mps() const;
  const RobotDescription& description() const { return robot_; }
  const mjModel& model() const { return *model_.physics; }
  mjOption& options() { return model_.physics->opt; }
  mjData& data() { return *data_; }

 private:
  void advance();

  RobotDescription robot_;
  AssembledModel model_;
  DataPtr data_;
  JointEncoderSettings encoder_settings_;
  ImuSensor imu_sensor_;
  JointEncoders encoders_;
  WheelDrive drive_;
  int body_;
  std::uint64_t tick_ = 0;
};

/// Returns the robot of models/wheeled.
std::string wheeled_urdf_text();

}  // namespace patrol::sim
