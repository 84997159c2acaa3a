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
  std::string text;  ///< one sentence: expected result, and bound on its distance from the optimum
};

/// Returns the order in which a robot at map's origin completes the stations of a route earliest
/// (plan/routes/station_order.h).
///
/// Stations of a lower priority value precede all others, time windows are respected if possible, and the route ends at
/// home. Paths are planned like the navigator's, on a map with the survey's keep-out lines only, at the mission's
/// expected speed. Returns the given order if a station cannot be reached.
StationOrder order_stations(const Route& route_in_map, const RobotDescription& robot,
                            const plan::NavigatorSettings& navigation, const GasMissionSettings& mission,
                            std::uint64_t seed);

}  // namespace patrol::stack
