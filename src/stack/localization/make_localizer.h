#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "core/boosted_stumps.h"
#include "core/robot_description.h"
#include "core/route.h"
#include "core/site/site_registration.h"
#include "stack/localization/localizer.h"
#include "stack/settings/stack_settings.h"

namespace patrol::stack {

struct LocalizerStart {
  std::optional<OccupancyGrid> map = {};                  ///< given map, in map
  std::optional<SiteRegistration> map_registration = {};  ///< registration of the given map, if it has been estimated
  bool has_mapping_drive = false;                         ///< true: the mission begins with a drive that makes the map
  BoostedStumps neighbor_model = {};                      ///< classifier of submap pairs, for SLAM methods that need it
};

/// Makes the localizer named by `settings.localizer`. "automatic" selects monte_carlo with a given map,
/// slam_then_monte_carlo with a mapping drive, and slam otherwise. Throws InputError if the localizer needs a map that
/// is missing, or cannot use the given one.
std::unique_ptr<Localizer> make_localizer(const StackSettings& settings, const RobotDescription& robot,
                                          const Route& site_in_map, const LocalizerStart& start, std::uint64_t seed);

}  // namespace patrol::stack
