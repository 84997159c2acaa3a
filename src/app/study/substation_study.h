#pragma once

#include "studies/study.h"

namespace patrol::app {

/// Study of [Yu23, tables 1 and 2, figure 6]: the substation mapped from identical logs by submaps of a particle
/// filter, by graph mapping and by a plain particle filter.
studies::Study substation_study();

/// Study of a drive past the substation's six identical bays, where every loop closure is wrong.
studies::Study row_study();

}  // namespace patrol::app
