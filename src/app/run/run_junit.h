#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/run/run_verdict.h"
#include "app/scenario.h"
#include "io/junit.h"

namespace patrol::app {

/// What a reader of the report needs to run it again: world, robot, mission, seed, version.
std::vector<std::pair<std::string, std::string>> junit_properties(const Scenario& scenario);

/// The red report that stands there from before the run until its end.
io::JunitSuite unfinished_suite(const std::string& name, const std::vector<std::pair<std::string, std::string>>& properties);

/// One case for how the run ended, one for each expectation, one for each declared event (skipped if NOT EXECUTED).
io::JunitSuite junit_suite(const std::string& name, const std::vector<std::pair<std::string, std::string>>& properties, const RunVerdict& verdict);

}  // namespace patrol::app
