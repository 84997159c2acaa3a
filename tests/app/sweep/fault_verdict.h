#pragma once

#include "app/run/run_verdict.h"

namespace patrol::test {

/// Of a run with one declared fault.
inline app::RunVerdict fault_verdict(const char* end, bool is_completed, int collisions, bool is_executed = true) {
  return {.end = end,
          .code = app::ExitCode::kDone,
          .message = "",
          .metrics = {{"mission", {{"completed", is_completed}, {"collisions", collisions}, {"sensor_faults_noticed", 1}}}, {"pose", {{"ate_rmse_m", 0.1}}}},
          .checks = {},
          .events = {{.what = "fault", .is_executed = is_executed}}};
}

}  // namespace patrol::test
