#include "plan/navigation/clear_costmap.h"

namespace patrol::plan {
namespace {

constexpr double kClearRadius_m = 2.0;

}  // namespace

void clear_around(Costmap& costmap, const Pose2& T_map_body) {
  costmap.clear_obstacles(T_map_body.position(), kClearRadius_m);
}

void ClearCostmap::begin(Time, const Pose2& T_map_body, Costmap& costmap) { clear_around(costmap, T_map_body); }

std::optional<VelocityCommand> ClearCostmap::step(Time, const Pose2&) { return std::nullopt; }

}  // namespace patrol::plan
