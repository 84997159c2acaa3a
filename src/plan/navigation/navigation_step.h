#pragma once

#include <string>
#include <vector>

#include "core/frames.h"
#include "core/messages.h"
#include "plan/routes/global_planner.h"

namespace patrol::plan {

/// kBlocked: no path to follow, or no room to follow it; kDriving also while the first route to a goal is being searched.
enum class NavigationStatus { kIdle, kDriving, kArrived, kBlocked, kRecovering, kFailed };

/// Reason for which the robot makes no progress.
enum class NavigationTrouble { kNone, kStartBlocked, kGoalBlocked, kNoRoute, kNoneFound, kPathBlocked, kStuck };

/// Trouble as one sentence; empty for none.
const char* sentence_of(NavigationTrouble trouble);

/// Trouble of a route search; none if it has found a route.
NavigationTrouble trouble_of(PlanStatus status);

/// Output of the navigator in one control period.
struct NavigationStep {
  VelocityCommand command;
  NavigationStatus status = NavigationStatus::kIdle;
  NavigationTrouble trouble = NavigationTrouble::kNone;
  std::string text;         ///< one sentence, in the step in which the trouble begins or the goal is given up; else empty
  std::string recovery;     ///< one sentence, in the step in which a recovery begins; else empty
  bool replanned = false;
  bool is_detour = false;   ///< replanned because of an obstacle on the path
  std::vector<Pose2> path;  ///< in map; filled when replanned
};

}  // namespace patrol::plan
