#pragma once

#include <vector>

#include "app/campaign/test/tested_scenario.h"
#include "report/blocks.h"

namespace patrol::app {

/// Report page of `patrol test`: the verdict, failures with their reasons, then all scenarios.
report::Page test_page(const std::vector<TestedScenario>& tested);

}  // namespace patrol::app
