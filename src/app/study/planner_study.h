#pragma once

#include "studies/study.h"

namespace patrol::app {

/// Study of [Li22, figures 1 to 4]: its ant colony compared with the ant system, two swarms and Q-learning, on
/// generated grids and on the worlds' reference maps. References are A* and the any-angle optimum.
studies::Study planner_study();

}  // namespace patrol::app
