#pragma once

#include "core/route.h"

namespace patrol::inspect {

/// A surveyed route in `map`: the survey also says where in `site` the robot starts, which is map's origin.
Route to_map(const Route& route_in_site, const Pose2& T_site_start);

}  // namespace patrol::inspect
