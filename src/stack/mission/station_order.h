#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/robot_description.h"
#include "core/route.h"
#include "plan/navigation/navigator.h"
#include "stack/mission/gas_mission.h"

namespace patrol::stack {

struct StationOrder {
  std::vector<Station> stations;
  std::string text;  ///< one sentence: what is expected of it, and how far it may be from the best
};

/// The order in which a robot at map's origin is soonest done with a route's stations (plan/routes/tour_order.h): those of a lower priority before all others,
/// windows kept if they can be, home at the end. Ways are planned as the navigator plans them, in a world of which only the survey's keep-out lines are
/// known; the robot does what it can at the mission's expected speed. The given order if one station cannot be reached.
StationOrder order_stations(const Route& route_in_map, const RobotDescription& robot, const plan::NavigatorSettings& navigation, const GasMissionSettings& mission,
                            std::uint64_t seed);

}  // namespace patrol::stack
