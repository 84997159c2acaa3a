#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include <Eigen/Core>

#include "core/frames.h"
#include "core/inspection_result.h"
#include "core/named_table.h"
#include "core/time.h"

/// Event kinds of a mission, with the text and class of each kind, and the event message.
namespace patrol {

/// Kind of an event. `kEventKinds` is the only table of their texts in logs and reports.
enum class EventKind : std::uint8_t {
  kForeign,
  // gas mission
  kMissionStarted,
  kStationReached,
  kStationLate,
  kStationFailed,
  kGasMeasured,
  kGasAlarm,
  // tunnel mission
  kGoalSaved,
  kGoalMoved,
  kMappingCompleted,
  kNavigationStarted,
  kGoalReached,
  kGoalFailed,
  kInspectionFailed,
  kTeleopRequested,
  kTeleopEnded,
  kDocked,
  kDockFailed,
  // every mission
  kMissionCompleted,
  kMissionFailed,
  // instruments
  kScanTaken,
  kReferenceTaken,
  kLiningUnchanged,
  kLiningNotice,
  kLiningWarning,
  kLiningAlarm,
  kWaterNotFound,
  kWaterNotice,
  kWaterWarning,
  kWaterAlarm,
  // localization, navigation and sensors
  kLocalizationLost,
  kRelocalized,
  kLocalizationFailed,
  kReplan,
  kNavigation,
  kRecovery,
  kDocking,
  kSensorFault,
  kSensorRecovered,
  kSensorFailed,
  kFall,
};

/// Class of an event kind.
enum class EventClass : std::uint8_t {
  kInformation,
  kHazard,      ///< a finding that endangers people or the site; the event's target is its position
  kTaskFailed,  ///< a task of the mission, or the mission, was not done
  kFault,       ///< the robot or one of its sensors failed
};

/// Row of the table of event kinds.
struct EventKindRow {
  EventKind value;
  std::string_view name;     ///< text in logs, reports and JSON
  std::string_view summary;  ///< one line of documentation
  EventClass event_class = EventClass::kInformation;
  WarningLevel level = WarningLevel::kNone;  ///< importance for an operator who monitors the robot
};

inline constexpr std::array kEventKinds = std::to_array<EventKindRow>({
    {EventKind::kForeign, "foreign", "Kind of another program, kept with its own text"},
    {EventKind::kMissionStarted, "mission_started", "The mission begins; names its stations in their order"},
    {EventKind::kStationReached, "station_reached", "The robot is at a station"},
    {EventKind::kStationLate, "station_late", "A station was reached after its time window; value: delay, s"},
    {EventKind::kStationFailed, "station_failed", "A station was not reached or not measured", EventClass::kTaskFailed,
     WarningLevel::kNotice},
    {EventKind::kGasMeasured, "gas_measured", "Methane was measured at a station; value: column, ppm m"},
    {EventKind::kGasAlarm, "gas_alarm",
     "The methane column exceeds its threshold; value: column, ppm m; target: the leak", EventClass::kHazard,
     WarningLevel::kAlarm},
    {EventKind::kGoalSaved, "goal_saved", "The operator saved a goal during teleoperation"},
    {EventKind::kGoalMoved, "goal_moved", "The final optimization of the map moved a saved goal; pose: the goal's"},
    {EventKind::kMappingCompleted, "mapping_completed", "The teleoperated mapping drive is over; the map is final"},
    {EventKind::kNavigationStarted, "navigation_started", "A run to all goals begins; value: its number"},
    {EventKind::kGoalReached, "goal_reached", "The robot is at a goal; value: number of the run"},
    {EventKind::kGoalFailed, "goal_failed", "A goal was not reached; value: number of the run", EventClass::kTaskFailed,
     WarningLevel::kNotice},
    {EventKind::kInspectionFailed, "inspection_failed", "An instrument gave no result at its station",
     EventClass::kTaskFailed, WarningLevel::kWarning},
    {EventKind::kTeleopRequested, "teleop_requested", "The robot waits at a goal for teleoperation"},
    {EventKind::kTeleopEnded, "teleop_ended", "Teleoperation is over; the robot continues autonomously"},
    {EventKind::kDocked, "docked", "The robot is docked at its charging post; value: number of the run"},
    {EventKind::kDockFailed, "dock_failed", "Docking or undocking failed; value: number of the run",
     EventClass::kTaskFailed, WarningLevel::kWarning},
    {EventKind::kMissionCompleted, "mission_completed", "Every task of the mission was done"},
    {EventKind::kMissionFailed, "mission_failed", "The mission is over and at least one task was not done",
     EventClass::kTaskFailed, WarningLevel::kWarning},
    {EventKind::kScanTaken, "scan_taken", "A panoramic scan was taken; value: number of points"},
    {EventKind::kReferenceTaken, "reference_taken", "First scan of a station: reference of later scans"},
    {EventKind::kLiningUnchanged, "lining_unchanged", "No ring of the lining near a station has moved"},
    {EventKind::kLiningNotice, "lining_notice", "A ring moved by more than the notice threshold; value: m inwards",
     EventClass::kInformation, WarningLevel::kNotice},
    {EventKind::kLiningWarning, "lining_warning", "A ring moved by more than the warning threshold; value: m inwards",
     EventClass::kHazard, WarningLevel::kWarning},
    {EventKind::kLiningAlarm, "lining_alarm", "A ring moved by more than the alarm threshold; value: m inwards",
     EventClass::kHazard, WarningLevel::kAlarm},
    {EventKind::kWaterNotFound, "water_not_found", "The soundings of a station show no water ahead"},
    {EventKind::kWaterNotice, "water_notice", "Water ahead, beyond the warning distance; value: distance, m",
     EventClass::kInformation, WarningLevel::kNotice},
    {EventKind::kWaterWarning, "water_warning", "Water ahead, within the warning distance; value: distance, m",
     EventClass::kInformation, WarningLevel::kWarning},
    {EventKind::kWaterAlarm, "water_alarm", "Water ahead, within the alarm distance; value: distance, m",
     EventClass::kHazard, WarningLevel::kAlarm},
    {EventKind::kLocalizationLost, "localization_lost", "Localization is lost: the robot stops and relocalizes",
     EventClass::kFault},
    {EventKind::kRelocalized, "relocalized", "Localization has recovered; value: time lost, s"},
    {EventKind::kLocalizationFailed, "localization_failed", "Relocalization timed out", EventClass::kFault,
     WarningLevel::kWarning},
    {EventKind::kReplan, "replan", "The path is blocked and planned again"},
    {EventKind::kNavigation, "navigation", "Navigation to a goal failed, with its reason"},
    {EventKind::kRecovery, "recovery", "A recovery behavior begins"},
    {EventKind::kDocking, "docking", "Report of the docking controller"},
    {EventKind::kSensorFault, "sensor_fault",
     "A sensor timed out, is frozen, or has a wrong clock; subject: the sensor", EventClass::kFault,
     WarningLevel::kWarning},
    {EventKind::kSensorRecovered, "sensor_recovered", "A sensor has recovered; subject: the sensor"},
    {EventKind::kSensorFailed, "sensor_failed", "A required sensor did not recover: the mission is aborted",
     EventClass::kFault},
    {EventKind::kFall, "fall", "The robot fell or rolled over: the mission is aborted", EventClass::kFault,
     WarningLevel::kAlarm},
});
static_assert(is_in_order(kEventKinds));

constexpr std::string_view name_of(EventKind kind) { return row_of(kEventKinds, kind).name; }
constexpr EventClass class_of(EventKind kind) { return row_of(kEventKinds, kind).event_class; }
constexpr WarningLevel level_of(EventKind kind) { return row_of(kEventKinds, kind).level; }
/// Returns whether an event of this kind reports a hazard, a failed task or a fault.
constexpr bool is_failure(EventKind kind) { return class_of(kind) != EventClass::kInformation; }

/// Returns the kind whose text is `name`; kForeign for texts that are not in the table.
constexpr EventKind event_kind_named(std::string_view name) {
  const EventKindRow* row = find_named(kEventKinds, name);
  return row == nullptr ? EventKind::kForeign : row->value;
}

/// Returns the kind of the event that reports a lining displacement of this level; kForeign for `kNone`.
constexpr EventKind lining_event(WarningLevel level) {
  constexpr std::array kKinds = {EventKind::kForeign, EventKind::kLiningNotice, EventKind::kLiningWarning,
                                 EventKind::kLiningAlarm};
  return kKinds[static_cast<std::size_t>(level)];
}

/// Returns the kind of the event that reports water ahead at this level; kForeign for `kNone`.
constexpr EventKind water_event(WarningLevel level) {
  constexpr std::array kKinds = {EventKind::kForeign, EventKind::kWaterNotice, EventKind::kWaterWarning,
                                 EventKind::kWaterAlarm};
  return kKinds[static_cast<std::size_t>(level)];
}

/// Event of the mission, for the log, the report and the score.
///
/// A log of another program may contain kinds that are not in the table. They are read as kForeign with their text in
/// `foreign_kind`. Reports and pages show that text, a rewritten log keeps it, and scores ignore the event.
struct Event {
  Time stamp{};
  EventKind kind = EventKind::kForeign;
  std::string subject = {};                                ///< object of the event, e.g. "regulator_box_2"
  std::string text = {};                                   ///< one sentence for a person
  double value = 0.0;                                      ///< value of the quantity that the kind reports, e.g. ppm m
  Pose2 T_map_body = {};                                   ///< estimated pose of the robot
  Eigen::Vector2d p_map_target = Eigen::Vector2d::Zero();  ///< position of the object in map, m; the robot's position
                                                           ///< if the event has no object
  std::string foreign_kind = {};  ///< text of a kind that is not in the table; empty for all others
};

/// Returns the text of the event's kind, also for a kind that is not in the table.
inline std::string kind_text(const Event& event) {
  return std::string(event.kind == EventKind::kForeign ? std::string_view(event.foreign_kind) : name_of(event.kind));
}

/// Sets the kind from its text.
inline void set_kind(Event& event, const std::string& text) {
  event.kind = event_kind_named(text);
  event.foreign_kind = event.kind == EventKind::kForeign ? text : "";
}

}  // namespace patrol
