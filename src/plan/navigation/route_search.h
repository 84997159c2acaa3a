#pragma once

#include <cstdint>
#include <optional>

#include "core/navigation_goal.h"
#include "core/time.h"
#include "plan/maneuvers/maneuver_planner.h"
#include "plan/navigation/navigator_settings.h"
#include "plan/perception/costmap.h"
#include "plan/routes/global_planner.h"

namespace patrol::plan {

/// Searches of the global planner, or of maneuvers for a robot that cannot turn in place, with a model of their
/// computation time on the robot.
class RouteSearch {
 public:
  struct Result {
    PlanResult route;
    bool is_detour = false;  ///< searched because of an obstacle on the path
  };

  /// `maneuvers`: planner that replaces the global planner, if any.
  RouteSearch(const NavigatorSettings& settings, std::uint64_t seed, std::optional<ManeuverPlanner> maneuvers = {});

  /// Resets the search for another goal: the next search may begin at once.
  void reset();
  /// Cancels the running search.
  void cancel() { running_.reset(); }
  bool is_running() const { return running_.has_value(); }
  void on_new_map() { has_new_map_ = true; }
  /// Whether the map has changed and the last search began `replan_period_s` ago.
  bool is_outdated(Time now) const;
  /// Whether no search is running and the minimum period since the start of the last one has passed: 0.5 s. From the
  /// same start, each successive search that takes longer than 50 ms and finds no route doubles it, up to 4 s.
  bool may_begin(Time now, const Pose2& T_map_start) const;
  /// Begins a search; the costmap grows to contain start and goal. `is_reversing`: present direction of travel.
  void begin(Time now, Costmap& costmap, const Pose2& T_map_start, const NavigationGoal& goal, bool is_detour,
             bool is_reversing = false);
  /// Result of the running search when its computation time has passed; else none.
  std::optional<Result> take(Time now);

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(running_, begun_at_, T_map_start_, num_failed_, has_new_map_);
  }

 private:
  struct Running {
    Result result;
    Time ready{};
  };

  PlanResult plan(Costmap& costmap, const Pose2& T_map_start, const NavigationGoal& goal, bool is_reversing);

  GlobalPlanner planner_;
  std::optional<ManeuverPlanner> maneuvers_;
  double planner_cells_per_s_, replan_period_s_;
  std::optional<Running> running_;
  Time begun_at_ = Time::min();  ///< time at which the last search began
  Pose2 T_map_start_;            ///< start of the route of the last search
  int num_failed_ = 0;           ///< successive slow searches from this start without a route
  bool has_new_map_ = false;
};

}  // namespace patrol::plan
