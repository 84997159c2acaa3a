#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/messages.h"
#include "core/sensors/registry.h"
#include "core/state/state_archive_fwd.h"
#include "stack/instruments/instrument_set.h"
#include "stack/localization/pose_pipeline.h"
#include "stack/localization/site_follower.h"
#include "stack/mission/mission.h"
#include "stack/motion_executor.h"
#include "stack/output/stack_output.h"
#include "stack/sensors/sensor_monitor.h"

namespace patrol::stack {

/// Components of a stack (make_stack.h selects them).
struct StackParts {
  PosePipeline pose;
  MotionExecutor motion;
  std::unique_ptr<Mission> mission;
  InstrumentSet instruments;
  SensorMonitor sensor_monitor;
  std::optional<Dock> dock;  ///< charging post of the site, in map
  SiteFollower site = {{}, {}, 1.0};
  double map_period_s = 5.0;  ///< interval between published maps while the map grows
};

/// Software of the robot: processes sensor messages and returns velocity commands, estimates, a map and events. Its
/// only inputs are sensor messages and the firmware's fall report, so that a recorded log can replace the simulator.
class Stack {
 public:
  explicit Stack(StackParts parts);

  /// Processes a message that arrived at `received`, which may precede the next step by any time.
  void handle(const SensorMessage& message, Time received);
  /// Processes the firmware's report of a fall.
  void handle_fall(Time now);
  /// Runs odometry, map, mission and control, each at its own period. Call at next_step() or before.
  void step(Time now);
  /// Time at which something is due next; in the past while the stack waits for odometry.
  Time next_step() const;

  const VelocityCommand& command() const { return command_; }
  bool mission_is_over() const { return parts_.mission->is_over(); }
  /// Ends the run: completes the map, and publishes it with the registration to the site.
  void finish(Time now);
  /// Removes and returns the messages published since the last call, in order.
  std::vector<StackMessage> take_messages() { return output_.take_messages(); }
  const StageProfiler& clock() const { return output_.clock(); }

  /// Saves or restores the state, between two steps. The stack has been made from the same settings. Throws
  /// std::runtime_error if the state is that of another stack.
  void serialize_state(StateArchive& archive);

 private:
  /// State of the robot in a control period.
  struct Period {
    Time now{};
    OdometryEstimate odometry;
    Pose2 T_odom_body;
    PoseEstimate pose;
  };

  void handle_scan(const LaserScan& raw, Time received);
  void publish_map(Time now);
  void finish_map(Time now, const OdometryEstimate& odometry);
  void follow_registration(Time now);
  void monitor_sensors(Time now, const Pose2& T_odom_body);
  VelocityCommand control(const Period& period);
  void advance_mission(const Period& period);
  void inspect(const Period& period);
  VelocityCommand drive(const Period& period);
  void relocalize(Relocalization how, const OdometryEstimate& odometry);

  StackParts parts_;
  StackOutput output_;
  Task task_;
  InspectionProgress inspection_;
  std::optional<TeleopCommand> new_teleop_;
  VelocityCommand command_;
  Time map_period_;
  Time next_control_{}, next_odometry_{}, next_map_{};
};

}  // namespace patrol::stack
