#pragma once

#include "app/study/study.h"

namespace patrol::app {

/// Paper 003, figures 1 to 4: its ants against a plain colony, two swarms and Q-learning, on generated grids and on the worlds' reference maps, with A* and the
/// any-angle optimum as references.
Study planner_study();

}  // namespace patrol::app
