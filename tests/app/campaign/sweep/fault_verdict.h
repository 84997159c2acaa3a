#pragma once

#include "app/run/run_verdict.h"

namespace patrol::test {

/// Verdict of a run with one declared fault.
inline app::RunVerdict fault_verdict(app::RunStatus end, bool is_completed, int collisions, bool was_triggered = true) {
  return {
      .end = end,
      .message = "",
      .metrics = {{"mission", {{"completed", is_completed}, {"collisions", collisions}, {"sensor_faults_noticed", 1}}},
                  {"pose", {{"ate_rmse_m", 0.1}}}},
      .checks = {},
      .events = {{.name = "fault imu freeze at 12 s", .was_triggered = was_triggered}}};
}

}  // namespace patrol::test
