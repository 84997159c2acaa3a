#pragma once

#include <filesystem>
#include <string>

#include "app/run/external_stack.h"
#include "app/scenario/scenario.h"

namespace patrol::app {

/// Returns the keys of a scenario that describe the robot, its documents and its software as YAML. Of the sensors it is
/// whether they are enabled, of a drive on wheels the type and the rollers. Other keys are left out: a stack does not
/// know the as-built robot, the faults, the obstacles or the leaks.
std::string known_settings(const Scenario& scenario);

/// Documents of a scenario for a stack in another process. `tick`: of the simulator.
StackDocuments stack_documents(const Scenario& scenario, const std::string& name, const ScenarioFiles& files,
                               const std::filesystem::path& data_root, Time tick);

}  // namespace patrol::app
