#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/messages.h"
#include "core/route.h"
#include "core/sensors/registry.h"
#include "core/state/state_archive_fwd.h"
#include "localize/map_correction.h"
#include "stack/mission/task.h"

namespace patrol::stack {

struct MissionInput {
  PoseEstimate pose;
  bool is_lost = false;            ///< true: localization has reported failure
  bool awaits_first_scan = false;  ///< true: the first scan, which defines the map's origin, is still to come
  NavigationFeedback navigation = NavigationFeedback::kDriving;
  DockingFeedback docking = DockingFeedback::kInProgress;
  InspectionProgress inspection = {};
  std::optional<TeleopCommand> teleop = {};  ///< command received since the last step
};

/// Action of the localizer: none, restart from the pose at the dock, or restart without prior knowledge of the pose.
enum class Relocalization { kNone, kAtDock, kAnywhere };

struct MissionOutput {
  Task task;
  bool is_map_complete = false;  ///< true in the step in which the mapping drive ends
  Relocalization relocalization = Relocalization::kNone;
  std::vector<Event> events;
};

/// Control period to which a mission's task applies.
///
/// kNow: the task is executed in the period in which it is issued, and the mission receives the feedback of the
/// previous period. kNext: the task is executed from the next period on, and the mission receives the feedback of its
/// own period.
enum class TaskTiming { kNow, kNext };

/// Interface of a mission: the sequence of tasks that the robot executes autonomously.
class Mission {
 public:
  virtual ~Mission() = default;

  /// Advances by one control period.
  virtual MissionOutput step(Time now, const MissionInput& input) = 0;
  /// Replaces the survey in map after the registration of the map to the site has changed.
  virtual void set_site(const Route& /*site_in_map*/) {}
  /// Moves everything that the mission has located in map while the map was made; returns an event for each move.
  virtual std::vector<Event> correct_map(Time /*now*/, const localize::MapCorrection& /*correction*/) { return {}; }
  virtual bool is_over() const = 0;
  /// Ends the mission, unless it is over, and returns an event of this kind.
  virtual Event abort(Time now, EventKind kind, const std::string& text) = 0;
  virtual TaskTiming timing() const = 0;
  /// Returns whether the robot starts at the surveyed start, the origin of map.
  virtual bool starts_at_survey() const = 0;

  /// Saves or restores the state.
  virtual void serialize_state(StateArchive& archive) = 0;
};

}  // namespace patrol::stack
