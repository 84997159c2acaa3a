#pragma once

#include "app/run/run_verdict.h"

namespace patrol::app::test {

/// Of a run with one declared fault.
inline RunVerdict fault_verdict(RunStatus end, bool is_completed, int collisions, bool is_executed = true) {
  return {.end = end,
          .message = "",
          .metrics = {{"mission", {{"completed", is_completed}, {"collisions", collisions}, {"sensor_faults_noticed", 1}}}, {"pose", {{"ate_rmse_m", 0.1}}}},
          .checks = {},
          .events = {{.what = "fault", .is_executed = is_executed}}};
}

}  // namespace patrol::app::test
