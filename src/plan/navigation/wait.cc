#include "plan/navigation/wait.h"

namespace patrol::plan {

void Wait::begin(Time now, const Pose2&, Costmap&) { until_ = now + from_seconds(duration_s_); }

std::optional<VelocityCommand> Wait::step(Time now, const Pose2&) {
  if (now >= until_) return std::nullopt;
  return VelocityCommand{};
}

}  // namespace patrol::plan
