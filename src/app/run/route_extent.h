#pragma once

#include <mujoco/mujoco.h>

#include "core/route.h"

namespace patrol::app {

/// Throws InputError for a station more than 50 m outside of the box around the static geoms of a site that have an
/// end. Planners search all cells between robot and station, and a run with such a station would hardly advance.
void require_stations_near(const Route& route, const mjModel& site);

}  // namespace patrol::app
