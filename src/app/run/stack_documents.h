#pragma once

#include <filesystem>
#include <string>

#include "app/run/external_stack.h"
#include "app/scenario/scenario.h"

namespace patrol::app {

/// Returns the part of a scenario that describes the robot, its documents and its software; of a drive on wheels the
/// type and the rollers. The rest has its defaults: a stack does not know the as-built robot, the faults, the obstacles
/// or the leaks.
Scenario documented_scenario(const Scenario& scenario);

/// Documents of a scenario for a stack in another process. `tick`: of the simulator.
StackDocuments stack_documents(const Scenario& scenario, const std::string& name, const ScenarioFiles& files,
                               const std::filesystem::path& data_root, Time tick);

}  // namespace patrol::app
