#pragma once

#include "app/report/run_contents.h"
#include "report/blocks.h"

namespace patrol::app {

/// Verdict of a run (passed, missed or incomplete) with its reason and everything that the scenario declares. Each
/// expectation has the wanted and the measured value, each fault and kidnap whether it was triggered.
report::VerdictBlock verdict_of(const RunContents& run);

/// Whether the ground truth in the log has the robot at the kidnap's position.
bool was_triggered(const KidnapSettings& kidnap, const Trajectory& T_world_body);

}  // namespace patrol::app
