#pragma once

#include <filesystem>
#include <vector>

#include "app/run/run_loop.h"

namespace patrol::app {

/// Feeds a stack with the messages of a run's log. Writes the messages, the answers and the ground truth of the run to
/// `log_mcap`: the log that the run would have with this stack if the answers had no effect. `tick`: of the simulator
/// of the run. `turns`: when the stack has its turns, with their delays; empty: when it asks for them, as in a run.
RunOutcome feed_loop(const std::filesystem::path& input_mcap, const ScenarioFiles& files, Time tick, StackPort& stack,
                     const std::filesystem::path& log_mcap, RunObserver& observer,
                     const std::vector<StackTurnRecord>& turns = {});

}  // namespace patrol::app
