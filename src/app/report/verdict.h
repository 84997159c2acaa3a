#pragma once

#include "app/report/run_contents.h"
#include "render/report/blocks.h"

namespace patrol::app {

/// Passed, missed or incomplete, why, and everything that the scenario declares: each expectation with what was wanted and what
/// came, each fault and kidnap with whether it was executed.
render::VerdictBlock verdict_of(const RunContents& run);

/// Whether the truth in the log shows the robot where it was to be put.
bool is_executed(const KidnapSettings& kidnap, const Trajectory& T_world_body);

}  // namespace patrol::app
