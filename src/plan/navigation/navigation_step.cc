#include "plan/navigation/navigation_step.h"

namespace patrol::plan {

const char* describe(NavigationFailure failure) {
  switch (failure) {
    case NavigationFailure::kNone:
      return "";
    case NavigationFailure::kStartBlocked:
      return "The robot stands too near to an obstacle to set off.";
    case NavigationFailure::kGoalBlocked:
      return "The goal lies in an obstacle or too near to one.";
    case NavigationFailure::kNoRoute:
      return "There is no route to the goal.";
    case NavigationFailure::kNotFound:
      return "The planner finds no route to the goal.";
    case NavigationFailure::kPathBlocked:
      return "Something stands in the way.";
    case NavigationFailure::kNoProgress:
      return "The robot moves and gets nowhere.";
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
