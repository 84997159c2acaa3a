#include "render/film/find_highlights.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace patrol::render {
namespace {

using Highlights = std::vector<Highlight>;

std::string humanize(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

std::string without_full_stop(std::string sentence) {
  if (sentence.ends_with('.')) sentence.pop_back();
  return humanize(std::move(sentence));
}

/// Moment that an event makes; none for events that are not worth a look.
std::optional<HighlightKind> moment_of(EventKind kind) {
  if (class_of(kind) == EventClass::kHazard) return HighlightKind::kAlarm;
  if (class_of(kind) == EventClass::kTaskFailed) return HighlightKind::kFailure;
  switch (kind) {
    case EventKind::kFall:
      return HighlightKind::kFall;
    case EventKind::kLocalizationLost:
    case EventKind::kLocalizationFailed:
      return HighlightKind::kLost;
    case EventKind::kRelocalized:
      return HighlightKind::kRelocalized;
    case EventKind::kSensorFailed:
      return HighlightKind::kFailure;
    case EventKind::kDocked:
      return HighlightKind::kDocking;
    case EventKind::kStationReached:
    case EventKind::kGoalReached:
      return HighlightKind::kGoal;
    case EventKind::kMappingCompleted:
    case EventKind::kNavigationStarted:
    case EventKind::kMissionCompleted:
      return HighlightKind::kMission;
    default:
      return std::nullopt;
  }
}

std::string title_of(const Event& event) {
  if (event.kind == EventKind::kGasAlarm)
    return fmt::format("Leak at {}: {:.0f} ppm m of methane", humanize(event.subject), event.value);
  if (event.kind == EventKind::kRelocalized) return fmt::format("Localization recovered after {:.1f} s", event.value);
  if (event.kind == EventKind::kLocalizationLost) return "Localization lost";
  return without_full_stop(event.text);
}

/// Height of a subject over the robot's body: that of the ring finding at its position, else 0.
double height_of(const Eigen::Vector2d& p_map_m, const std::vector<RingFinding>& findings) {
  constexpr double kSame_m = 0.01;
  const auto found = std::ranges::find_if(
      findings, [&](const RingFinding& finding) { return (finding.p_map.head<2>() - p_map_m).norm() < kSame_m; });
  return found == findings.end() ? 0.0 : found->p_map.z();
}

void add_events(const RunHistory& history, const Pose2& T_world_map, Highlights& highlights) {
  for (const Event& event : history.events) {
    const std::optional<HighlightKind> kind = moment_of(event.kind);
    if (!kind) continue;
    Highlight highlight{.at = event.stamp, .kind = *kind, .title = title_of(event)};
    if (*kind == HighlightKind::kAlarm) {
      highlight.p_world_subject = T_world_map * event.p_map_target;
      highlight.subject_height_m = height_of(event.p_map_target, history.ring_findings);
    }
    highlights.push_back(std::move(highlight));
  }
}

/// Merges contacts less than 3 s apart into one collision.
void add_collisions(const RunHistory& history, Highlights& highlights) {
  constexpr Time kOneCollision = std::chrono::seconds(3);
  std::optional<Time> last;
  for (const Collision& collision : history.collisions) {
    if (!last || collision.stamp > *last + kOneCollision) {
      highlights.push_back(
          {collision.stamp, HighlightKind::kCollision, "Collision with " + humanize(collision.second)});
    }
    last = collision.stamp;
  }
}

/// Closest approach of each encounter; approaches of one actor less than 5 s apart are one encounter.
std::vector<Approach> encounters(const std::vector<Approach>& approaches, double near_m) {
  constexpr Time kOneEncounter = std::chrono::seconds(5);
  std::vector<Approach> met;
  std::optional<Time> last;
  for (const Approach& approach : approaches) {
    if (approach.clearance_m >= near_m) continue;
    const bool is_same = last && approach.at <= *last + kOneEncounter && met.back().actor == approach.actor;
    if (!is_same) met.push_back(approach);
    else if (approach.clearance_m < met.back().clearance_m) met.back() = approach;
    last = approach.at;
  }
  return met;
}

void add_near_misses(const RunHistory& history, const HighlightSettings& settings, Highlights& highlights) {
  std::vector<Approach> met = encounters(history.approaches, settings.near_miss_m);
  std::ranges::stable_sort(met, {}, &Approach::clearance_m);
  if (met.size() > static_cast<std::size_t>(settings.max_near_misses))
    met.resize(static_cast<std::size_t>(settings.max_near_misses));
  for (const Approach& approach : met) {
    highlights.push_back({approach.at, HighlightKind::kNearMiss,
                          fmt::format("{:.2f} m from {}", approach.clearance_m, humanize(approach.actor)),
                          approach.p_world_actor});
  }
}

void add_max_error(const RunHistory& history, const HighlightSettings& settings, Highlights& highlights) {
  const auto size_m = [](const EstimateError& error) { return error.error_in_world_m.norm(); };
  const auto largest = std::ranges::max_element(history.errors, {}, size_m);
  if (largest == history.errors.end() || size_m(*largest) < settings.min_error_m) return;
  highlights.push_back(
      {largest->at, HighlightKind::kMaxError, fmt::format("Maximum position error: {:.3f} m", size_m(*largest))});
}

/// Adds steps of the true pose that the robot cannot make itself.
void add_kidnaps(const RunHistory& history, const HighlightSettings& settings, Highlights& highlights) {
  for (std::size_t i = 1; i < history.T_world_body.size(); ++i) {
    const double leap_m = (history.T_world_body[i].pose.position - history.T_world_body[i - 1].pose.position).norm();
    if (leap_m >= settings.kidnap_m) {
      highlights.push_back(
          {history.T_world_body[i].stamp, HighlightKind::kKidnap, fmt::format("Kidnapped: moved {:.0f} m", leap_m)});
    }
  }
}

/// Adds steps of the error that are not caused by a step of the true pose.
void add_corrections(const RunHistory& history, const HighlightSettings& settings, Highlights& highlights) {
  constexpr Time kAround = std::chrono::milliseconds(500);
  const Highlights before = highlights;
  const auto is_kidnap_near = [&](Time at) {
    return std::ranges::any_of(before, [&](const Highlight& m) {
      return m.kind == HighlightKind::kKidnap && m.at <= at + kAround && at <= m.at + kAround;
    });
  };
  for (std::size_t i = 1; i < history.errors.size(); ++i) {
    const double jump_m = (history.errors[i].error_in_world_m - history.errors[i - 1].error_in_world_m).norm();
    if (jump_m < settings.correction_m || is_kidnap_near(history.errors[i].at)) continue;
    highlights.push_back(
        {history.errors[i].at, HighlightKind::kCorrection, fmt::format("Estimate corrected by {:.2f} m", jump_m)});
  }
}

}  // namespace

std::vector<Highlight> find_highlights(const RunHistory& history, const Pose2& T_world_map,
                                       std::vector<Highlight> announced, const HighlightSettings& settings) {
  Highlights highlights = std::move(announced);
  add_events(history, T_world_map, highlights);
  add_collisions(history, highlights);
  add_near_misses(history, settings, highlights);
  add_max_error(history, settings, highlights);
  add_kidnaps(history, settings, highlights);
  add_corrections(history, settings, highlights);
  std::erase_if(highlights,
                [&](const Highlight& highlight) { return highlight.at < history.begin || highlight.at > history.end; });
  std::ranges::stable_sort(highlights, {}, &Highlight::at);
  return highlights;
}

}  // namespace patrol::render
