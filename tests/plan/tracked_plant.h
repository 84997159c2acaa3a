#pragma once

#include <deque>

#include "core/frames.h"
#include "core/messages.h"
#include "plan/control/dwa.h"

namespace patrol::plan {

/// A skid-steered robot as the planner meets it: commands take effect late, the tracks slip ahead and more so in
/// turning, and it turns about a point that is not the body's origin.
struct TrackedPlant {
  double turn_slip = 0.25;     ///< share of the yaw rate that is lost
  double way_slip = 0.03;      ///< share of the speed that is lost
  double turn_center_m = 0.0;  ///< ahead of the body's origin
  int late_ticks = 1;          ///< control periods until a command takes effect
  Pose2 T_map_body;
  std::deque<VelocityCommand> on_the_way;

  void move(const VelocityCommand& command, double period_s) {
    on_the_way.push_back(command);
    if (static_cast<int>(on_the_way.size()) <= late_ticks) return;
    const VelocityCommand now = on_the_way.front();
    on_the_way.pop_front();
    const Pose2 T_body_center{turn_center_m, 0.0, 0.0};
    T_map_body = follow_arc(T_map_body * T_body_center, (1.0 - way_slip) * now.vx_mps,
                            (1.0 - turn_slip) * now.yaw_rate_radps, period_s) *
                 T_body_center.inverse();
  }
};

}  // namespace patrol::plan
