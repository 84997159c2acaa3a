#include "plan/navigation/spin.h"

#include <cmath>
#include <numbers>

#include "plan/navigation/clear_costmap.h"

namespace patrol::plan {
namespace {

constexpr double kTimeoutFactor = 2.0;  // slipping tracks turn more slowly than commanded

}  // namespace

void Spin::begin(Time now, const Pose2& T_map_body, Costmap& costmap) {
  clear_around(costmap, T_map_body);
  until_ = now + from_seconds(kTimeoutFactor * 2.0 * std::numbers::pi / rate_radps_);
  turned_rad_ = 0.0;
  yaw_before_rad_ = T_map_body.yaw;
}

std::optional<VelocityCommand> Spin::step(Time now, const Pose2& T_map_body) {
  turned_rad_ += std::abs(wrap_angle(T_map_body.yaw - yaw_before_rad_));
  yaw_before_rad_ = T_map_body.yaw;
  if (now >= until_ || turned_rad_ >= 2.0 * std::numbers::pi) return std::nullopt;
  return VelocityCommand{.yaw_rate_radps = rate_radps_};
}

}  // namespace patrol::plan
