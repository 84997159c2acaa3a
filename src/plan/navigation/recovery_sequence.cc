#include "plan/navigation/recovery_sequence.h"

#include "core/error.h"
#include "plan/navigation/back_up.h"
#include "plan/navigation/clear_costmap.h"
#include "plan/navigation/motion_check.h"
#include "plan/navigation/spin.h"
#include "plan/navigation/wait.h"

namespace patrol::plan {

std::unique_ptr<RecoveryBehavior> make_recovery(const std::string& name, const NavigatorSettings& settings) {
  if (name == "wait") return std::make_unique<Wait>(settings.blocked_timeout_s);
  if (name == "clear_costmap") return std::make_unique<ClearCostmap>();
  if (name == "back_up")
    return std::make_unique<BackUp>(settings.recovery.back_up_duration_s, settings.recovery.back_up_speed_mps);
  if (name == "spin") return std::make_unique<Spin>(settings.turn_in_place_rate_radps);
  throw InputError("navigation.recovery.behaviors = " + name + ": must be one of wait, clear_costmap, back_up, spin");
}

RecoverySequence::RecoverySequence(const NavigatorSettings& settings) : max_attempts_(settings.recovery.max_attempts) {
  if (settings.recovery.behaviors.empty())
    throw InputError("navigation.recovery.behaviors: must name at least one behavior");
  for (const std::string& name : settings.recovery.behaviors) behaviors_.push_back(make_recovery(name, settings));
}

const char* RecoverySequence::begin_next(Time now, const Pose2& T_map_body, Costmap& costmap) {
  active_ = static_cast<std::size_t>(num_begun_) % behaviors_.size();
  ++num_begun_;
  behaviors_[active_]->begin(now, T_map_body, costmap);
  return behaviors_[active_]->sentence();
}

std::optional<VelocityCommand> RecoverySequence::step(Time now, const Pose2& T_map_body, const Costmap& costmap) {
  const std::optional<VelocityCommand> command = behaviors_[active_]->step(now, T_map_body);
  if (command && is_motion_safe(costmap, T_map_body, *command, 1.0)) return command;
  return std::nullopt;
}

}  // namespace patrol::plan
