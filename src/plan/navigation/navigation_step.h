#pragma once

#include <string>
#include <vector>

#include "core/frames.h"
#include "core/messages.h"
#include "plan/routes/global_planner.h"

namespace patrol::plan {

/// Status of a navigation. kBlocked: no path, or no room to follow it. kDriving includes the time of the first route
/// search.
enum class NavigationStatus { kIdle, kDriving, kArrived, kBlocked, kRecovering, kFailed };

/// Reason for which the robot makes no progress.
enum class NavigationFailure { kNone, kStartBlocked, kGoalBlocked, kNoRoute, kNotFound, kPathBlocked, kNoProgress };

/// Description of a failure as one sentence; empty for kNone.
const char* describe(NavigationFailure failure);

/// Failure that corresponds to the status of a route search; kNone if it has found a route.
NavigationFailure to_failure(PlanStatus status);

/// Output of the navigator in one control period.
struct NavigationStep {
  VelocityCommand command;
  NavigationStatus status = NavigationStatus::kIdle;
  NavigationFailure failure = NavigationFailure::kNone;
  std::string text;      ///< one sentence in the step in which the failure begins or the goal is aborted; else empty
  std::string recovery;  ///< one sentence in the step in which a recovery begins; else empty
  bool replanned = false;
  bool is_detour = false;   ///< replanned because of an obstacle on the path
  std::vector<Pose2> path;  ///< path in map; filled if replanned
};

}  // namespace patrol::plan
