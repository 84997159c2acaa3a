#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/ground_truth.h"
#include "core/messages.h"
#include "core/part_clock.h"
#include "core/robot_description.h"
#include "core/sensors/registry.h"
#include "sim/actors.h"
#include "sim/antenna_mount.h"
#include "sim/gas_plume.h"
#include "sim/lining_moves.h"
#include "sim/locomotion/locomotion.h"
#include "sim/locomotion/quadruped_controller.h"
#include "sim/locomotion/track_drive_settings.h"
#include "sim/model_assembly.h"
#include "sim/nearby_scenery.h"
#include "sim/props.h"
#include "sim/remote_operator.h"
#include "sim/sensors/sensor_suite.h"
#include "sim/water_ahead.h"

namespace patrol::sim {

/// The physical side of a scenario: which world, which robot, and what is in the air and on the road.
struct TwinSettings {
  std::string world_xml;
  std::string robot_urdf;
  Pose2 T_world_start;  ///< where the robot is put down
  SensorSuiteSettings sensors;
  LocomotionSettings locomotion;   ///< of a robot with legs
  TrackDriveSettings track_drive;  ///< of a robot with tracks
  std::vector<PropSettings> props;
  std::optional<TunnelLining> lining;            ///< of the world, in world
  std::vector<LiningMoveSettings> lining_moves;
  std::vector<ActorSettings> actors;
  std::vector<LeakSettings> leaks;
  WindSettings wind;
  Underground underground;
  std::vector<FaultSettings> faults;
  RemoteDrive drive;                    ///< in world; driven by a person with a remote control, empty: nobody
  RemoteOperatorSettings driver;
  std::vector<RemoteCommand> recorded;  ///< or: what a remote control said on another day
};

/// The digital twin: robot, world, sensors and actors, advanced tick by tick. It takes velocity commands and gives what
/// the sensors say; the truth is for the log and the judge.
class Twin {
 public:
  /// A depth camera needs `make_depth_imager` (render/depth_renderer.h).
  Twin(const TwinSettings& settings, const RobotDescription& robot, std::uint64_t seed,
       const DepthImagerFactory& make_depth_imager = {});

  /// One physics tick (2 ms).
  void step();

  /// Time since the start; of the state that `truth` describes.
  Time now() const { return now_; }
  void set_command(const VelocityCommand& command) { command_ = command; }
  /// What is asked of the inspection's instruments; now.
  void command(const InstrumentCommand& command);
  /// An instrument is at work, or the antenna is out: the robot must stand still.
  bool is_busy() const { return sensors_.is_busy() || (antenna_ && antenna_->is_out(*data_)); }

  /// Sensor messages whose delivery is due, in order of delivery.
  std::vector<SensorMessage> take_messages();

  GroundTruth truth() const;
  SimState state() const;
  /// New touches since the last call; one entry per touch, not per tick.
  std::vector<Collision> take_collisions();
  /// By the firmware's own sensing.
  bool has_fallen() const { return locomotion_->has_fallen(); }

  /// Lifts the robot to another place and puts it down there, upright on the ground, at rest, its firmware switched on anew. It
  /// sees the ground from a metre above where it is now. Throws InputError where there is no ground.
  void put_at(const Pose2& T_world_body);

  const SensorSuite& sensors() const { return sensors_; }
  const mjModel& physics() const { return *model_.physics; }
  const PartClock& clock() const { return clock_; }

 private:
  void hold_still();
  void hear_remote();
  void note_collisions();
  void throw_if_diverged() const;

  AssembledModel model_;
  DataPtr data_;
  NearbyScenery nearby_;
  int robot_body_;
  double robot_radius_m_;
  TwinSettings settings_;
  std::unique_ptr<Locomotion> locomotion_;
  std::optional<AntennaMount> antenna_;
  Actors actors_;
  SensorSuite sensors_;
  std::optional<RemoteOperator> driver_;
  std::vector<RemoteCommand> recorded_;
  std::size_t num_replayed_ = 0;
  VelocityCommand command_;
  Time now_{};
  Time tick_;
  std::vector<Collision> collisions_;
  std::vector<std::pair<std::string, Time>> touching_;  ///< pairs in contact, with the last time seen
  PartClock clock_;
};

}  // namespace patrol::sim
