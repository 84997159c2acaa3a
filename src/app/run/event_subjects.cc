#include "app/run/event_subjects.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "app/run/checked_message.h"
#include "core/text.h"

namespace patrol::app {

EventSubjects::EventSubjects(std::vector<std::string> stations, std::vector<std::string> goals)
    : stations_{.names = std::move(stations)}, goals_{.names = std::move(goals)} {}

std::string EventSubjects::warning_of(const Event& event) {
  if (event.kind == EventKind::kGoalSaved) goals_.names.push_back(event.subject);
  const bool is_of_station = event.kind == EventKind::kStationReached;
  if (!is_of_station && event.kind != EventKind::kGoalReached && event.kind != EventKind::kGoalFailed) return {};
  Group& group = is_of_station ? stations_ : goals_;
  if (group.was_reported || std::ranges::find(group.names, event.subject) != group.names.end()) return {};
  group.was_reported = true;
  return fmt::format("{} with subject {} is not scored: {} of the run: {}", name_of(event.kind),
                     event.subject.empty() ? "\"\"" : quoted_name(event.subject), is_of_station ? "stations" : "goals",
                     group.names.empty() ? "none" : join(group.names, ", "));
}

}  // namespace patrol::app
