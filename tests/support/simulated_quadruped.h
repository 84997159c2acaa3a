#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/frames.h"
#include "core/ground_truth.h"
#include "core/messages.h"
#include "core/robot_description.h"
#include "core/sensors/registry.h"
#include "sim/collision_culler.h"
#include "sim/locomotion/quadruped_controller.h"
#include "sim/model_assembly.h"
#include "sim/sensors/foot_contact.h"
#include "sim/sensors/imu.h"
#include "sim/sensors/joint_encoders.h"

namespace patrol::sim {

inline const std::string kRobotUrdf = PATROL_SOURCE_DIR "/models/quadruped/quadruped.urdf";
inline const std::string kStreetXml = PATROL_SOURCE_DIR "/worlds/street/street.xml";
inline constexpr Pose2 kStreetStart{11.0, 8.0, 1.5707963267948966};

/// A world with the contact options of the street and what is given of scenery.
std::string make_world(const std::string& geoms);
/// World of `make_world` with flat ground under everything.
std::string make_flat_world(const std::string& geoms = "");

/// Result of a walk, by ground truth.
struct WalkReport {
  Pose2 moved;                    ///< end in the start's frame; the yaw is unwrapped
  double mean_forward_mps = 0.0;  ///< in level
  double mean_sideways_mps = 0.0;
  double mean_yaw_rate_radps = 0.0;
  double roll_rms_rad = 0.0;  ///< about the mean
  double pitch_rms_rad = 0.0;
  double max_tilt_rad = 0.0;  ///< maximum tilt of the trunk's z axis
  double min_height_m = 0.0;  ///< minimum height of the trunk's origin, in world
  double slip_mps = 0.0;      ///< mean speed of a loaded foot's sole along the ground
  double max_torque_nm = 0.0;
  double velocity_error_mps = 0.0;  ///< RMS of the controller's own velocity, in level
  int steps_taken = 0;              ///< lift-offs
  bool has_fallen = false;
};

/// The quadruped with noisy sensors and its controller, in a world of its own: what the simulator does, without
/// the rest.
class WalkingRobot {
 public:
  /// `world` is MJCF.
  explicit WalkingRobot(const std::string& world, const Pose2& T_world_start = {}, std::uint64_t seed = 1,
                        const LocomotionSettings& settings = {});
  explicit WalkingRobot(AssembledModel model, std::uint64_t seed = 1, const LocomotionSettings& settings = {});
  WalkingRobot(AssembledModel model, RobotDescription robot, std::uint64_t seed, const LocomotionSettings& settings);

  WalkReport walk(double vx_mps, double vy_mps, double yaw_rate_radps, double duration_s);
  WalkReport stand(double duration_s) { return walk(0.0, 0.0, 0.0, duration_s); }

  /// Bias of the gyro about z in addition to the sensor's own.
  void add_gyro_bias(double radps) { gyro_bias_radps_ += radps; }
  /// Bias of the accelerometer in addition to the sensor's own; the estimated vertical tilts by it.
  void add_accelerometer_bias(const Eigen::Vector3d& mps2) { accelerometer_bias_mps2_ += mps2; }
  Pose3 T_world_body() const;
  const mjModel& view() const { return *model_.view; }
  /// Truth, in level.
  Eigen::Vector3d velocity_mps() const;
  const QuadrupedController& controller() const { return controller_; }
  const mjModel& model() const { return *model_.physics; }
  mjData& data() { return *data_; }
  const mjData& state() const { return *data_; }
  /// One tick: the firmware, then the physics.
  void step(const VelocityCommand& command) {
    drive(command);
    advance();
  }
  void drive(const VelocityCommand& command);
  void advance();

 private:
  double loaded_slip_mps(int leg) const;
  bool is_loaded(int leg) const { return contacts_.force_n[static_cast<std::size_t>(leg)] > loaded_n_; }

  RobotDescription robot_;
  AssembledModel model_;
  DataPtr data_;
  CollisionCuller culler_;
  ImuSensor imu_sensor_;
  JointEncoders encoders_;
  FootContactSensor foot_sensor_;
  QuadrupedController controller_;
  int body_;
  std::array<int, kNumLegs> foot_geom_;
  std::array<int, 3 * kNumLegs> motor_;  ///< [joint]
  double loaded_n_;                      ///< 20 N for a robot of 13.6 kg
  Imu imu_;
  double gyro_bias_radps_ = 0.0;
  Eigen::Vector3d accelerometer_bias_mps2_ = Eigen::Vector3d::Zero();
  JointState joints_;
  FootContacts contacts_;
  std::uint64_t tick_ = 0;
};

}  // namespace patrol::sim
