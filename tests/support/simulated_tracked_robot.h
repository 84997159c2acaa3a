#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/frames.h"
#include "core/messages.h"
#include "core/robot_description.h"
#include "core/sensors/registry.h"
#include "sim/collision_culler.h"
#include "sim/locomotion/track_drive.h"
#include "sim/model_assembly.h"
#include "sim/sensors/hall_sensors.h"
#include "sim/sensors/imu.h"

namespace patrol::sim {

inline const std::string kTrackedUrdf = PATROL_SOURCE_DIR "/models/tracked/tracked.urdf";

/// The robot of the URDF, so that a test can change its limits.
RobotDescription tracked_description();

/// Result of a drive, by ground truth and by the robot's own counters.
struct DriveReport {
  Pose2 moved;  ///< end in the start's frame; the yaw is unwrapped
  double climbed_m = 0.0;
  double left_belt_m = 0.0;  ///< travel of the left track by ticks
  double right_belt_m = 0.0;
  double mean_left_nm = 0.0;  ///< mean torque of the left motor
  double mean_right_nm = 0.0;
  double max_tilt_rad = 0.0;
  double mean_contacts = 0.0;
  bool has_fallen = false;
};

/// The tracked robot with noisy sensors and its drive in a world of its own: what the simulator does, without the rest.
class TrackedRobot {
 public:
  /// `world` is MJCF. The robot has settled when this returns.
  explicit TrackedRobot(const std::string& world, const Pose2& T_world_start = {},
                        const TrackDriveSettings& settings = {}, const RobotDescription& robot = tracked_description(),
                        std::uint64_t seed = 1, bool uses_nearby_scenery = true);

  DriveReport drive(double vx_mps, double yaw_rate_radps, double duration_s);
  DriveReport stand(double duration_s) { return drive(0.0, 0.0, duration_s); }

  Pose3 T_world_body() const;
  const RobotDescription& description() const { return robot_; }
  const mjModel& model() const { return *model_.physics; }
  const AssembledModel& assembled() const { return model_; }
  mjOption& options() { return model_.physics->opt; }
  /// Force of the robot on a geom, N.
  double force_on_n(const std::string& geom) const;
  mjData& data() { return *data_; }
  const TrackTicks& ticks() const { return ticks_; }
  /// One tick: the firmware, then the physics.
  void step(const VelocityCommand& command) {
    command_drive(command);
    advance();
  }
  void command_drive(const VelocityCommand& command);
  void advance();

 private:
  RobotDescription robot_;
  AssembledModel model_;
  DataPtr data_;
  std::optional<CollisionCuller> culler_;
  HallSettings hall_settings_;
  ImuSensor imu_sensor_;
  HallSensors hall_;
  TrackDrive drive_;
  int body_;
  Imu imu_;
  TrackTicks ticks_;
  std::uint64_t tick_ = 0;
};

}  // namespace patrol::sim
