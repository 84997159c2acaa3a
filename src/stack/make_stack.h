#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/boosted_stumps.h"
#include "core/robot_description.h"
#include "core/route.h"
#include "core/site/site_frame.h"
#include "core/site/site_registration.h"
#include "stack/instruments/lining_instrument.h"
#include "stack/settings/stack_settings.h"
#include "stack/stack.h"

namespace patrol::stack {

/// Initial data of a stack besides the survey; in map unless the member says otherwise.
struct StackStart {
  std::optional<OccupancyGrid> map = {};                  ///< none: the robot makes its own map
  std::optional<SiteRegistration> map_registration = {};  ///< none: the origin of the map is the surveyed start
  std::vector<SavedGoal> goals = {};  ///< none: saved during teleoperation, or the mission visits the route's stations
  LiningReferences references = {};   ///< scans of an earlier inspection run
  BoostedStumps neighbor_model = {};  ///< classifier of submap pairs, for SLAM methods that need it
  bool has_teleop = false;            ///< true: an operator can drive the robot by teleoperation
  SiteFrame site = {};                ///< pose of the surveyed start in site, and datum
  double map_period_s = 5.0;
  std::uint64_t seed = 0;
  bool has_thread = false;  ///< whether SLAM has a thread of its own, with the same results
};

/// Composes a stack. The settings select odometry source, localizer and mission; the robot description and the survey
/// select the instruments. `site_in_map`: the survey in a map whose origin, the level body pose at the start,
/// is the surveyed start exactly; it moves with the registration (localize/registration/register_to_site.h). Throws
/// InputError when settings, robot, survey and start are inconsistent.
Stack make_stack(const StackSettings& settings, const RobotDescription& robot, const Route& site_in_map,
                 StackStart start);

}  // namespace patrol::stack
