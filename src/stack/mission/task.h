#pragma once

#include <optional>

#include "core/navigation_goal.h"
#include "stack/instruments/inspection_order.h"

namespace patrol::stack {

/// Motion that a mission can request. kNavigate without a goal is kStand.
enum class Motion { kStand, kTeleop, kNavigate, kUndock, kDock };

/// Request of a mission in a control period: a motion, and optionally an inspection at the same time.
struct Task {
  Motion motion = Motion::kStand;
  std::optional<NavigationGoal> goal;  ///< goal of kNavigate
  std::optional<InspectionOrder> inspection;
};

/// Result of the navigation to the goal of the task.
enum class NavigationFeedback { kDriving, kArrived, kFailed };

/// Result of kDock and kUndock.
enum class DockingFeedback { kInProgress, kDone, kFailed };

}  // namespace patrol::stack
