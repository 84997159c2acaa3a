#pragma once

#include "app/study/study.h"

namespace patrol::app {

/// Paper 000, table 2: the street mapped from the logs of the same patrols by grid SLAM with one proposal or another.
Study street_study();

}  // namespace patrol::app
