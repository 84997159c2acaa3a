#include "plan/navigation/back_up.h"

#include "plan/navigation/clear_costmap.h"

namespace patrol::plan {

void BackUp::begin(Time now, const Pose2& T_map_body, Costmap& costmap) {
  clear_around(costmap, T_map_body);
  until_ = now + from_seconds(duration_s_);
}

std::optional<VelocityCommand> BackUp::step(Time now, const Pose2&) {
  if (now >= until_) return std::nullopt;
  return VelocityCommand{.vx_mps = -speed_mps_};
}

}  // namespace patrol::plan
