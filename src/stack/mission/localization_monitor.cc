#include "stack/mission/localization_monitor.h"

#include <string>

#include <fmt/format.h>

namespace patrol::stack {

LocalizationMonitor::Status LocalizationMonitor::step(Time now, bool is_lost, const Pose2& T_map_body,
                                                      std::vector<Event>& events) {
  const auto report = [&](EventKind kind, const std::string& text, double value = 0.0) {
    events.push_back({.stamp = now,
                      .kind = kind,
                      .text = text,
                      .value = value,
                      .T_map_body = T_map_body,
                      .p_map_target = T_map_body.position()});
  };
  if (!is_lost) {
    if (lost_since_) report(EventKind::kRelocalized, "Relocalized.", to_seconds(now - *lost_since_));
    lost_since_.reset();
    return Status::kUsable;
  }
  if (!lost_since_) {
    lost_since_ = now;
    report(EventKind::kLocalizationLost, "Localization lost: robot stopped, relocalizing.");
  } else if (now - *lost_since_ > timeout_) {
    report(EventKind::kLocalizationFailed, fmt::format("Relocalization failed after {:.0f} s.", to_seconds(timeout_)));
    return Status::kFailed;
  }
  return Status::kRelocalizing;
}

}  // namespace patrol::stack
