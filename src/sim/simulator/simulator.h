#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/ground_truth.h"
#include "core/messages.h"
#include "core/robot_description.h"
#include "core/sensors/registry.h"
#include "core/stage_profiler.h"
#include "core/state/state_archive_fwd.h"
#include "sim/actors.h"
#include "sim/antenna_mount.h"
#include "sim/as_built/as_built_robot.h"
#include "sim/collision_culler.h"
#include "sim/gas_plume.h"
#include "sim/ground.h"
#include "sim/lining_deformation.h"
#include "sim/locomotion/locomotion.h"
#include "sim/locomotion/quadruped_controller.h"
#include "sim/locomotion/track_drive_settings.h"
#include "sim/locomotion/wheel_drive_settings.h"
#include "sim/model_assembly.h"
#include "sim/sensors/sensor_suite.h"
#include "sim/site_settings.h"
#include "sim/static_obstacles.h"
#include "sim/subsurface.h"
#include "sim/teleop_operator.h"

namespace patrol::sim {

/// Physical side of a scenario: world, robot, environment and traffic.
struct SimulatorSettings {
  std::string world_xml;
  SiteSettings site;
  RobotUrdf robot_urdf;
  Pose2 T_world_start;  ///< start pose of the robot, before the placement error of the as-built robot
  AsBuiltSettings as_built;
  SensorSuiteSettings sensors;
  LocomotionSettings locomotion;   ///< settings for a robot with legs
  TrackDriveSettings track_drive;  ///< settings for a robot with tracks
  WheelDriveSettings wheel_drive;  ///< settings for a robot with wheels
  std::vector<StaticObstacleSettings> static_obstacles;
  std::optional<TunnelLining> lining;  ///< lining of the world, in world
  std::vector<LiningDeformationSettings> lining_deformations;
  std::vector<ActorSettings> actors;
  std::vector<LeakSettings> leaks;
  WindSettings wind;
  Subsurface subsurface;
  std::vector<FaultSettings> faults;
  TeleopRoute teleop_route;  ///< teleoperated route, in world; empty: no operator
  TeleopOperatorSettings teleop_operator;
  std::vector<TeleopCommand> recorded;  ///< recorded teleoperation commands, replayed instead of `teleop_route`
  bool has_sensor_thread = false;       ///< expensive sensors have a thread of their own, with the same results
};

/// Simulator of robot, world, sensors and actors, advanced tick by tick. Takes velocity commands and returns sensor
/// messages. The ground truth is only for logging and scoring.
class Simulator {
 public:
  /// A depth camera requires `make_depth_imager` (render/scene/depth_renderer.h).
  Simulator(const SimulatorSettings& settings, const RobotDescription& robot, std::uint64_t seed,
            const DepthImagerFactory& make_depth_imager = {});

  /// Advances the simulation by one physics tick (2 ms).
  void step();

  /// Returns the time since the start, of the state that `truth` describes.
  Time now() const { return now_; }
  /// Returns the time from one physics step to the next.
  Time tick() const { return tick_; }
  void set_command(const VelocityCommand& command) { command_ = command; }
  /// Passes a command to the inspection instruments; effective at once.
  void command(const InstrumentCommand& command);
  /// Returns whether the robot must stand still because an instrument is measuring or the antenna is not stowed.
  bool is_busy() const { return sensors_.is_busy() || (antenna_ && antenna_->is_deployed(*data_)); }

  /// Removes and returns the sensor messages that are due, in order of delivery.
  std::vector<SensorMessage> take_messages();

  GroundTruth truth() const;
  /// Returns the values drawn for the simulated robot; empty for a nominal robot.
  AsBuiltTruth as_built() const;
  SimState state() const;
  /// Removes and returns the collisions that began since the last call; one entry per collision, not per tick.
  std::vector<Collision> take_collisions();
  /// Returns whether the robot has fallen, according to the firmware's own sensors.
  bool has_fallen() const { return locomotion_->has_fallen(); }

  /// Moves the robot to another pose, upright on the ground and at rest, and restarts its firmware. The ground is
  /// searched from a meter above the robot's present height. Throws InputError where there is no ground.
  void teleport(const Pose2& T_world_body);

  const SensorSuite& sensors() const { return sensors_; }
  const mjModel& physics() const { return *model_.physics; }
  /// Returns the physical state after the last step, for measurements by ground truth.
  const mjData& data() const { return *data_; }
  const StageProfiler& clock() const { return clock_; }

  /// Saves or restores the state. The simulator has been created from the same scenario; faults that have not begun may
  /// differ. Throws std::runtime_error if the state is that of another scenario.
  void serialize_state(StateArchive& archive);

 private:
  void suppress_slip();
  void receive_teleop();
  void record_collisions();
  void throw_if_diverged() const;

  std::uint64_t seed_;
  AsBuiltRobot robot_;
  AssembledModel model_;
  DataPtr data_;
  CollisionCuller culler_;
  Ground ground_;
  int robot_body_;
  double robot_radius_m_;
  SimulatorSettings settings_;
  std::unique_ptr<Locomotion> locomotion_;
  std::optional<AntennaMount> antenna_;
  Actors actors_;
  SensorSuite sensors_;
  std::optional<TeleopOperator> operator_;
  std::vector<TeleopCommand> recorded_;
  std::size_t num_replayed_ = 0;
  VelocityCommand command_;
  Time now_{};
  Time tick_;
  std::vector<Collision> collisions_;
  std::vector<std::pair<std::string, Time>> contacts_;  ///< pairs in contact, with the last time of contact
  StageProfiler clock_;
};

}  // namespace patrol::sim
