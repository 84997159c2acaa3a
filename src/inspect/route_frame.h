#pragma once

#include "core/route.h"

namespace patrol::inspect {

/// Transforms a surveyed route from `site` to `map`. The surveyed start pose of the robot is the origin of map.
Route to_map(const Route& route_in_site, const Pose2& T_site_start);

}  // namespace patrol::inspect
