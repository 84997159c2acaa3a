#include "stack/instruments/warning_light.h"

#include <algorithm>

namespace patrol::stack {

void WarningLight::warn(Time now, WarningLevel level, StackOutput& output) {
  if (level < WarningLevel::kWarning) return;
  const bool is_alarm = level == WarningLevel::kAlarm;
  if (is_alarm) siren_until_ = now + from_seconds(siren_s_);
  if (level <= max_warning_ && !is_alarm) return;
  max_warning_ = std::max(max_warning_, level);
  output.publish(WarningCommand{now, true, siren_until_.has_value()});
}

void WarningLight::step(Time now, StackOutput& output) {
  if (!siren_until_ || now < *siren_until_) return;
  siren_until_.reset();
  output.publish(WarningCommand{now, max_warning_ >= WarningLevel::kWarning, false});
}

}  // namespace patrol::stack
