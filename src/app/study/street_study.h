#pragma once

#include "studies/study.h"

namespace patrol::app {

/// Study of [Wu25, table 2]: the street mapped from the logs of identical patrols by grid SLAM with different
/// proposals.
studies::Study street_study();

}  // namespace patrol::app
