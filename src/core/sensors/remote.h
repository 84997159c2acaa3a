#pragma once

#include "core/sensors/sensor_traits.h"
#include "core/time.h"

namespace patrol {

/// What the person at the remote control does: the velocity asked for, and two buttons.
struct RemoteCommand {
  Time stamp{};
  double vx_mps = 0.0;
  double yaw_rate_radps = 0.0;
  bool mark = false;       ///< pressed now: this place is a goal
  bool hand_over = false;  ///< pressed now: the robot goes on by itself
};

template <>
struct SensorTraits<RemoteCommand> {
  struct Settings {};
  static constexpr SensorInfo kInfo = {.name = "remote",
                                      .topic = "/remote",
                                      .ros_type = "patrol_msgs/msg/RemoteCommand",
                                      .summary = "remote control of an operator",
                                      .trigger = SensorTrigger::kTeleoperation,
                                      .fault = {.unit = "m/s", .drift_per_s = 0.02, .spike = 0.3}};

  static void add_to_reading(RemoteCommand& command, double offset_mps) { command.vx_mps += offset_mps; }
};

}  // namespace patrol
