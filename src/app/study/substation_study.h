#pragma once

#include "app/study/study.h"

namespace patrol::app {

/// Paper 002, tables 1 and 2 and figure 6: the substation mapped from the same logs by submaps of a particle filter, by graph mapping and by a plain particle
/// filter.
Study substation_study();

/// Past the substation's six identical bays, where whoever says that he has been here before is wrong.
Study row_study();

}  // namespace patrol::app
