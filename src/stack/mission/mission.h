#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/messages.h"
#include "core/sensors/registry.h"
#include "stack/mission/task.h"

namespace patrol::stack {

struct MissionInput {
  PoseEstimate pose;
  bool is_lost = false;  ///< the localizer does not know the pose
  NavigationFeedback navigation = NavigationFeedback::kDriving;
  DockingFeedback docking = DockingFeedback::kUnderWay;
  InspectionProgress inspection = {};
  std::optional<RemoteCommand> remote = {};  ///< command received since the last step
};

/// What the localizer does now: nothing special, start from the pose at the dock, or start without any knowledge of the
/// pose.
enum class Relocalization { kNone, kAtDock, kAnywhere };

struct MissionOutput {
  Task task;
  bool map_is_made = false;  ///< now: the mapping drive is over
  Relocalization relocalization = Relocalization::kNone;
  std::vector<Event> events;
};

/// Control period to which a mission's task applies. kNow: the task is carried out in the period in which it is given,
/// and the mission sees the feedback of the period before. kNext: the task is carried out from the next period on, and
/// the mission sees the feedback of its own period.
enum class TaskTiming { kNow, kNext };

/// Interface of a mission: the sequence of tasks that the robot carries out by itself.
class Mission {
 public:
  virtual ~Mission() = default;

  /// Advances by a control period.
  virtual MissionOutput step(Time now, const MissionInput& input) = 0;
  virtual bool is_over() const = 0;
  /// Ends the mission, unless it is over, and returns an event of this kind.
  virtual Event abort(Time now, EventKind kind, const std::string& text) = 0;
  virtual TaskTiming timing() const = 0;
  /// The robot starts at the surveyed start, the origin of map.
  virtual bool starts_at_survey() const = 0;
};

}  // namespace patrol::stack
