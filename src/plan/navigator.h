#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/messages.h"
#include "core/named_table.h"
#include "core/navigation_goal.h"
#include "core/robot_description.h"
#include "plan/costmap.h"
#include "plan/differential_approach.h"
#include "plan/dwa.h"
#include "plan/global_planner.h"
#include "plan/local_planner.h"
#include "plan/paper_dwa.h"
#include "plan/planned_path.h"
#include "plan/pose_regulator.h"

namespace patrol::plan {

struct NavigatorSettings;

/// The local planners; `make` takes the settings of its own section.
std::span<const NamedFactory<std::unique_ptr<LocalPlanner>(const NavigatorSettings&)>> local_planners();

struct NavigatorSettings {
  std::string drive = "omnidirectional";  ///< or "differential": a robot that cannot step sideways
  std::string global = "theta_star";      ///< planner of the way to the goal (plan/routes/planners.h)
  std::string local_planner = "dwa";      ///< or "paper_dwa": paper 004's, as printed
  int footprint_rows = 1;             ///< of discs that stand for the outline (plan/footprint.h)
  double steps_per_s = 1e7;               ///< cells that the robot's computer looks at in a second: a route comes so much later
  double replan_period_s = 4.0;       ///< a new path after this time, for what the map has learnt
  double check_ahead_m = 6.0;         ///< an obstacle on the path nearer than this calls for a new one at once
  double stray_m = 0.8;               ///< so does being farther than this from it
  double approach_m = 0.4;            ///< from here on the goal is approached by itself, whatever the path
  double approach_decel_mps2 = 0.3;   ///< speed on the way falls so that the robot can stop at the goal
  double turn_first_rad = 1.0;        ///< the path leads off by more than this: turn in place first
  double turn_rate_radps = 0.7;
  double patience_s = 6.0;            ///< standing blocked for so long calls for a recovery
  double stuck_s = 15.0;              ///< so does moving for so long without getting half a metre away
  double detour_after_s = 0.0;        ///< what has newly come into the way is waited for so long: people walk on
  double newcomer_distance_m = 0.0;   ///< something the map does not know, nearer ahead than this, calls for caution; 0: never
  double newcomer_speed_mps = 0.4;    ///< no faster then: it may be somebody who walks
  double no_route_s = 600.0;          ///< after so long without any route the goal is given up
  std::vector<std::string> recoveries = {"back_up"};  ///< in turn: wait, clear, back_up, look_around; then a new path
  double back_up_s = 2.0;             ///< backwards, if there is room
  double back_up_speed_mps = 0.15;
  int max_recoveries = 8;             ///< without getting nearer; then the goal is given up
  CostmapSettings costmap;
  DepthPointsSettings depth;
  SonarConeSettings sonar;
  GlobalPlannerSettings routes;
  DwaSettings local;
  PaperDwaSettings paper_local;
  PoseRegulatorSettings approach;                      ///< of an omnidirectional robot
  DifferentialApproachSettings differential_approach;  ///< of a differential one

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("drive", self.drive, one_of({"omnidirectional", "differential"}));
    visit("global", self.global, one_of(drivable_route_planners()));
    visit("local_planner", self.local_planner, one_of(local_planners()));
    visit("footprint_rows", self.footprint_rows, between(1, 4));
    visit("steps_per_s", self.steps_per_s, between(1e3, 1e12));
    visit("replan_period_s", self.replan_period_s, between(0.1, 600.0));
    visit("check_ahead_m", self.check_ahead_m, between(0.5, 100.0));
    visit("stray_m", self.stray_m, between(0.1, 10.0));
    visit("approach_m", self.approach_m, between(0.05, 3.0));
    visit("approach_decel_mps2", self.approach_decel_mps2, between(0.05, 5.0));
    visit("turn_first_rad", self.turn_first_rad, between(0.2, 3.2));
    visit("turn_rate_radps", self.turn_rate_radps, between(0.05, 3.0));
    visit("patience_s", self.patience_s, between(0.5, 600.0));
    visit("stuck_s", self.stuck_s, between(1.0, 600.0));
    visit("detour_after_s", self.detour_after_s, between(0.0, 60.0));
    visit("newcomer_distance_m", self.newcomer_distance_m, between(0.0, 10.0));
    visit("newcomer_speed_mps", self.newcomer_speed_mps, between(0.05, 5.0));
    visit("no_route_s", self.no_route_s, between(0.5, 3600.0));
    visit("recoveries", self.recoveries, one_of({"wait", "clear", "back_up", "look_around"}));
    visit("back_up_s", self.back_up_s, between(0.0, 20.0));
    visit("back_up_speed_mps", self.back_up_speed_mps, between(0.0, 1.0));
    visit("max_recoveries", self.max_recoveries, between(0, 1000));
    visit("costmap", self.costmap);
    visit("depth", self.depth);
    visit("sonar", self.sonar);
    visit("routes", self.routes);
    visit("local", self.local);
    visit("paper_local", self.paper_local);
    visit("approach", self.approach);
    visit("differential_approach", self.differential_approach);
  }
};

/// kBlocked: nothing to follow, or no room for it; kDriving also while the first route to a goal is being looked for.
enum class NavigationStatus { kIdle, kDriving, kArrived, kBlocked, kRecovering, kFailed };

/// Why it does not get on.
enum class NavigationTrouble { kNone, kStartBlocked, kGoalBlocked, kNoRoute, kNoneFound, kPathBlocked, kStuck };

/// The same as one sentence; empty for none.
const char* sentence_of(NavigationTrouble trouble);

struct NavigationStep {
  VelocityCommand command;
  NavigationStatus status = NavigationStatus::kIdle;
  NavigationTrouble trouble = NavigationTrouble::kNone;
  std::string text;         ///< one sentence, in the step in which the trouble begins or the goal is given up; else empty
  std::string recovery;     ///< one sentence, in the step in which a recovery begins; else empty
  bool replanned = false;
  bool is_detour = false;   ///< replanned because something stands on the path
  std::vector<Pose2> path;  ///< in map; filled when replanned
};

/// Takes the body to a goal: costmap, a global planner for the way, the dynamic window for every step of it, an approach of its own at
/// the end. Blocked, it waits, then recovers (backs up, looks around) and plans anew, and says so when there is no way.
class Navigator {
 public:
  /// `seed`: of the global planners that draw. Throws InputError if a setting breaks its rule or the robot has no footprint.
  Navigator(const NavigatorSettings& settings, const RobotDescription& robot, std::vector<Polyline> keep_out_lines_in_map, std::uint64_t seed = 0);

  void set_map(const OccupancyGrid& map);
  void add_scan(const LevelScan& scan, const Pose2& T_map_body) { costmap_.add_scan(scan, T_map_body); }
  /// `T_level_body`: the body's tilt. Throw InputError if the robot has no such camera or transducer.
  void add_depth(const DepthImage& image, const Pose3& T_level_body, const Pose2& T_map_body);
  void add_range(const UltrasonicRange& ping, const Pose3& T_level_body, const Pose2& T_map_body);
  /// The same goal again changes nothing; none stops the robot.
  void set_goal(const std::optional<NavigationGoal>& goal);

  /// Once a control period.
  NavigationStep step(Time now, const Pose2& T_map_body);

  /// Whether the robot can move like that for half a second without touching anything known.
  bool is_free(const Pose2& T_map_body, const VelocityCommand& command) const { return is_safe(T_map_body, command, 0.5); }

  const Costmap& costmap() const { return costmap_; }
  const PlannedPath& path() const { return path_; }

 private:
  struct Stay {
    Eigen::Vector2d p_map;
    Time since{};
  };
  /// A route that is being looked for.
  struct Search {
    PlanResult found;
    Time ready{};
    bool is_detour = false;
  };
  struct Recovery {
    std::string kind;
    Time until{};
    double turned_rad = 0.0;
    double yaw_before = 0.0;
  };

  bool has_given_up(Time now) const;
  bool is_path_blocked(double from_m) const;
  bool is_blocked_by_newcomer(Time now) const;
  void search_if_needed(Time now, const Pose2& T_map_body);
  void take_route(Time now, const Pose2& T_map_body, NavigationStep& step);
  bool is_at_goal(const Pose2& T_map_body) const;
  void note_no_route(Time now, NavigationTrouble trouble);
  NavigationStatus carry_on_recovery(Time now, const Pose2& T_map_body, VelocityCommand& command);
  NavigationStatus drive(Time now, const Pose2& T_map_body, VelocityCommand& command);
  NavigationStatus approach(Time now, const Pose2& T_map_body, VelocityCommand& command);
  VelocityCommand follow_path(const Pose2& T_map_body);
  bool is_newcomer_ahead(const Pose2& T_map_body) const;
  bool turn_in_place(const Pose2& T_map_body, VelocityCommand& command) const;
  NavigationStatus think(Time now);
  NavigationStatus stand_blocked(Time now, const Pose2& T_map_body, VelocityCommand& command);
  bool is_stuck(Time now, const Pose2& T_map_body);
  NavigationStatus recover(Time now, const Pose2& T_map_body, VelocityCommand& command);
  void say(NavigationTrouble trouble);
  bool is_safe(const Pose2& T_map_body, const VelocityCommand& command, double time_s) const;
  void note_progress(const Pose2& T_map_body);

  NavigatorSettings settings_;
  RobotDescription robot_;
  Costmap costmap_;
  GlobalPlanner planner_;
  std::unique_ptr<LocalPlanner> local_planner_;
  DifferentialApproach approach_;

  std::optional<NavigationGoal> goal_;
  bool has_arrived_ = false;
  bool is_approaching_ = false;       ///< the differential approach drives
  PlannedPath path_;
  double along_m_ = 0.0;
  std::optional<Search> search_;
  Time planned_at_ = Time::min();     ///< when the last search began
  bool map_is_new_ = false;
  VelocityCommand last_;              ///< the command before, in place of the noisy measured twist
  std::optional<Time> blocked_since_;
  std::optional<Stay> stay_;          ///< where the robot has been about for how long
  std::optional<Recovery> recovery_;
  std::optional<Time> no_route_since_;
  NavigationTrouble trouble_ = NavigationTrouble::kNone;
  std::string text_, recovery_text_;  ///< not said yet
  bool has_given_up_ = false;
  int recoveries_ = 0;
  double nearest_left_m_ = 0.0;       ///< the shortest way left so far
};

}  // namespace patrol::plan
