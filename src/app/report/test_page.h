#pragma once

#include <vector>

#include "app/test/tested_scenario.h"
#include "render/report/blocks.h"

namespace patrol::app {

/// The page of a `patrol test`: the verdict, what failed and why, then all.
render::Page test_page(const std::vector<TestedScenario>& tested);

}  // namespace patrol::app
