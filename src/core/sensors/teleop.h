#pragma once

#include "core/sensors/sensor_traits.h"
#include "core/time.h"

namespace patrol {

/// Command of the teleoperator: velocity and two buttons.
struct TeleopCommand {
  Time stamp{};
  double vx_mps = 0.0;
  double yaw_rate_radps = 0.0;
  bool save_goal = false;  ///< button to save the current pose as a goal, pressed in this message
  bool hand_over = false;  ///< button to switch to autonomous mode, pressed in this message
};

template <>
struct SensorTraits<TeleopCommand> {
  struct Settings {};
  static constexpr SensorInfo kInfo = {.name = "teleop",
                                       .topic = "/teleop",
                                       .ros_type = "patrol_msgs/msg/TeleopCommand",
                                       .summary = "teleoperation commands of an operator",
                                       .trigger = SensorTrigger::kTeleoperation,
                                       .fault = {.unit = "m/s", .drift_per_s = 0.02, .outlier = 0.3}};

  static void add_to_reading(TeleopCommand& command, double offset_mps) { command.vx_mps += offset_mps; }
};

}  // namespace patrol
