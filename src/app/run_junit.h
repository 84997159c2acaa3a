#pragma once

#include <string>
#include <vector>

#include "app/expectations.h"
#include "app/run_directory.h"
#include "app/run_loop.h"

namespace patrol::app {

/// The red report that stands there from before the run until its end.
void write_unfinished_junit(const RunDirectory& directory, const Scenario& scenario, const std::string& name);

/// "imu freeze at 12 s".
std::string describe(const sim::FaultSettings& fault);

/// One case for how the run ended, one for each expectation, one for each declared fault (skipped if NOT EXECUTED).
void write_junit(const RunDirectory& directory, const Scenario& scenario, const std::string& name, const RunOutcome& outcome,
                 const std::vector<CheckedExpectation>& checks);

}  // namespace patrol::app
