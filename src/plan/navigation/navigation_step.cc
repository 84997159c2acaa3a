#include "plan/navigation/navigation_step.h"

namespace patrol::plan {

const char* describe(NavigationFailure failure) {
  switch (failure) {
    case NavigationFailure::kNone:
      return "";
    case NavigationFailure::kStartBlocked:
      return "Start pose is in collision.";
    case NavigationFailure::kGoalBlocked:
      return "Goal pose is blocked: obstacle, keep-out line or unknown space.";
    case NavigationFailure::kNoRoute:
      return "No path to the goal exists.";
    case NavigationFailure::kNotFound:
      return "Planner failed to find a path (planner is not complete).";
    case NavigationFailure::kPathBlocked:
      return "Path is blocked.";
    case NavigationFailure::kNoProgress:
      return "Robot is not making progress.";
  }
  return "";
}

NavigationFailure to_failure(PlanStatus status) {
  switch (status) {
    case PlanStatus::kStartBlocked:
      return NavigationFailure::kStartBlocked;
    case PlanStatus::kGoalBlocked:
      return NavigationFailure::kGoalBlocked;
    case PlanStatus::kNoRoute:
      return NavigationFailure::kNoRoute;
    case PlanStatus::kNotFound:
      return NavigationFailure::kNotFound;
    case PlanStatus::kFound:
      break;
  }
  return NavigationFailure::kNone;
}

}  // namespace patrol::plan
