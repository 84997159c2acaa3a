#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "core/boosted_stumps.h"
#include "core/robot_description.h"
#include "core/route.h"
#include "stack/localization/localizer.h"
#include "stack/settings/stack_settings.h"

namespace patrol::stack {

struct LocalizerStart {
  std::optional<OccupancyGrid> map = {};  ///< known before the start, in map
  bool has_mapping_drive = false;         ///< the mission begins with a drive that makes the map
  BoostedStumps neighbor_model = {};      ///< classifier of pairs of submaps, for SLAM methods that need it
  double height_above_ground_m = 0.0;     ///< of the body's origin, as the robot stands
};

/// Makes the localizer that `settings.localizer` names; "automatic" stands for monte_carlo with a known map, for
/// slam_then_monte_carlo with a mapping drive, for slam otherwise. Throws InputError if the map that the localizer
/// needs is missing, or one is given that it cannot use.
std::unique_ptr<Localizer> make_localizer(const StackSettings& settings, const RobotDescription& robot,
                                          const Route& site_in_map, const LocalizerStart& start, std::uint64_t seed);

}  // namespace patrol::stack
