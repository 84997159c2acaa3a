#pragma once

#include <optional>

#include "core/navigation_goal.h"
#include "stack/instruments/inspection_order.h"

namespace patrol::stack {

/// Motions that a mission can ask for. kNavigate without a goal is kStand.
enum class Motion { kStand, kFollowRemote, kNavigate, kUndock, kDock };

/// What a mission asks of the robot in a control period: a motion, and work of an instrument meanwhile.
struct Task {
  Motion motion = Motion::kStand;
  std::optional<NavigationGoal> goal;  ///< with kNavigate
  std::optional<InspectionOrder> inspection;
};

/// Result of the navigation to the goal of the task.
enum class NavigationFeedback { kDriving, kArrived, kFailed };

/// Result of kDock and kUndock.
enum class DockingFeedback { kUnderWay, kDone, kFailed };

}  // namespace patrol::stack
