#include "plan/navigation/navigation_step.h"

namespace patrol::plan {

const char* sentence_of(NavigationTrouble trouble) {
  switch (trouble) {
    case NavigationTrouble::kNone:
      return "";
    case NavigationTrouble::kStartBlocked:
      return "The robot stands too near to an obstacle to set off.";
    case NavigationTrouble::kGoalBlocked:
      return "The goal lies in an obstacle or too near to one.";
    case NavigationTrouble::kNoRoute:
      return "There is no route to the goal.";
    case NavigationTrouble::kNoneFound:
      return "The planner finds no route to the goal.";
    case NavigationTrouble::kPathBlocked:
      return "Something stands in the way.";
    case NavigationTrouble::kStuck:
      return "The robot moves and gets nowhere.";
  }
  return "";
}

NavigationTrouble trouble_of(PlanStatus status) {
  switch (status) {
    case PlanStatus::kStartBlocked:
      return NavigationTrouble::kStartBlocked;
    case PlanStatus::kGoalBlocked:
      return NavigationTrouble::kGoalBlocked;
    case PlanStatus::kNoRoute:
      return NavigationTrouble::kNoRoute;
    case PlanStatus::kNoneFound:
      return NavigationTrouble::kNoneFound;
    case PlanStatus::kFound:
      break;
  }
  return NavigationTrouble::kNone;
}

}  // namespace patrol::plan
