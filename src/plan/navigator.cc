#include "plan/navigator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/error.h"

namespace patrol::plan {
namespace {

constexpr double kPathStep_m = 0.25;          // poses of the published path
constexpr double kProgress_m = 0.5;           // that much nearer counts as getting on
constexpr double kMinApproachSpeed_mps = 0.15;
constexpr double kMinPassable_m = 0.02;       // of a turn in place
constexpr Time kAtOnce = std::chrono::milliseconds(50);  // a search that is over so soon holds nothing up
constexpr double kTurnPatience = 2.0;         // tracks that slip turn more slowly than asked

Twist3 twist_of(const VelocityCommand& command) {
  return {.linear = {command.vx_mps, command.vy_mps, 0.0}, .angular = {0.0, 0.0, command.yaw_rate_radps}};
}

/// Of the body's origin above the ground. Robots on legs have no sensors that ask for it.
double body_height_m(const RobotDescription& robot) { return robot.tracks ? robot.tracks->body_height_m : 0.0; }

bool stands_still(const VelocityCommand& command) {
  return std::abs(command.vx_mps) < 0.03 && std::abs(command.vy_mps) < 0.03 && std::abs(command.yaw_rate_radps) < 0.05;
}

using LocalPlannerFactory = NamedFactory<std::unique_ptr<LocalPlanner>(const NavigatorSettings&)>;

constexpr std::array kLocalPlanners = std::to_array<LocalPlannerFactory>({
    {"dwa", "Dynamic window approach over forward simulated arcs",
     [](const NavigatorSettings& settings) -> std::unique_ptr<LocalPlanner> { return std::make_unique<DynamicWindow>(settings.local); }},
    {"paper_dwa", "Dynamic window approach of paper 004, as printed",
     [](const NavigatorSettings& settings) -> std::unique_ptr<LocalPlanner> { return std::make_unique<PaperDwa>(settings.paper_local); }},
});

std::string sentence_of_recovery(const std::string& kind) {
  if (kind == "wait") return "Recovery: the robot waits.";
  if (kind == "clear") return "Recovery: the robot forgets what it saw about it.";
  if (kind == "back_up") return "Recovery: the robot backs up.";
  return "Recovery: the robot looks around.";
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

}  // namespace

std::span<const LocalPlannerFactory> local_planners() { return kLocalPlanners; }

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

Navigator::Navigator(const NavigatorSettings& settings, const RobotDescription& robot,
                     std::vector<Polyline> keep_out_lines_in_map, std::uint64_t seed)
    : settings_(settings),
      robot_(robot),
      costmap_(settings.costmap, Footprint(robot.footprint_m, settings.footprint_rows), std::move(keep_out_lines_in_map)),
      planner_(settings.global, settings.routes, seed),
      local_planner_(row_named(kLocalPlanners, settings.local_planner, "plan.local_planner").make(settings)),
      approach_(settings.differential_approach) {
  validate(settings, "plan");
  if (settings.recoveries.empty()) throw InputError("plan.recoveries: must name at least one recovery");
}

void Navigator::set_map(const OccupancyGrid& map) {
  costmap_.set_map(map);
  map_is_new_ = true;
}

void Navigator::add_depth(const DepthImage& image, const Pose3& T_level_body, const Pose2& T_map_body) {
  const Pose3 T_level_camera = T_level_body * robot_.T_body("depth_camera");
  costmap_.add_image(find_depth_points(settings_.depth, image, T_level_camera, body_height_m(robot_)), image.stamp, T_map_body);
}

void Navigator::add_range(const UltrasonicRange& ping, const Pose3& T_level_body, const Pose2& T_map_body) {
  const Pose3 T_level_transducer = T_level_body * robot_.T_body("ultrasonic_" + std::to_string(ping.transducer));
  const SonarCone cone =
      find_sonar_cone(settings_.sonar, ping, T_level_transducer, body_height_m(robot_), settings_.costmap.resolution_m);
  costmap_.add_ping(cone, ping.stamp, T_map_body);
}

void Navigator::set_goal(const std::optional<NavigationGoal>& goal) {
  if (goal == goal_) return;
  goal_ = goal;
  has_arrived_ = false;
  is_approaching_ = false;
  path_ = {};
  search_.reset();
  planned_at_ = Time::min();
  blocked_since_.reset();
  stay_.reset();
  recovery_.reset();
  no_route_since_.reset();
  trouble_ = NavigationTrouble::kNone;
  text_.clear();
  recovery_text_.clear();
  has_given_up_ = false;
  recoveries_ = 0;
  nearest_left_m_ = std::numeric_limits<double>::infinity();
}

NavigationStep Navigator::step(Time now, const Pose2& T_map_body) {
  NavigationStep step;
  if (goal_) {
    if (has_arrived_ || is_at_goal(T_map_body)) {
      has_arrived_ = true;
      trouble_ = NavigationTrouble::kNone;
      step.status = NavigationStatus::kArrived;
    } else if (has_given_up(now)) {
      if (!has_given_up_) text_ = std::string("The goal is given up. ") + sentence_of(trouble_);
      has_given_up_ = true;
      step.status = NavigationStatus::kFailed;
    } else if (recovery_) {
      step.status = carry_on_recovery(now, T_map_body, step.command);
    } else if (is_stuck(now, T_map_body)) {
      say(NavigationTrouble::kStuck);
      step.status = recover(now, T_map_body, step.command);
    } else {
      search_if_needed(now, T_map_body);
      take_route(now, T_map_body, step);
      if (!path_.is_empty()) step.status = drive(now, T_map_body, step.command);
      else if (search_) step.status = think(now);
      else step.status = stand_blocked(now, T_map_body, step.command);
    }
  }
  step.trouble = trouble_;
  step.text = std::exchange(text_, {});
  step.recovery = std::exchange(recovery_text_, {});
  last_ = step.command;
  return step;
}

bool Navigator::has_given_up(Time now) const {
  const bool has_no_route = no_route_since_ && now - *no_route_since_ > from_seconds(settings_.no_route_s);
  return has_given_up_ || recoveries_ > settings_.max_recoveries || has_no_route;
}

void Navigator::say(NavigationTrouble trouble) {
  if (trouble != trouble_) text_ = sentence_of(trouble);
  trouble_ = trouble;
}

/// Whether something stands on the path within `check_ahead_m`.
bool Navigator::is_path_blocked(double from_m) const {
  const double to_m = std::min(path_.length_m(), from_m + settings_.check_ahead_m);
  for (double along_m = from_m; along_m < to_m; along_m += costmap_.settings().resolution_m) {
    if (costmap_.cost_at(path_.point_at(along_m)) == kLethalCost) return true;
  }
  return false;
}

/// Whether all that stands on the path has only just come there.
bool Navigator::is_blocked_by_newcomer(Time now) const {
  const CostmapSettings& costmap = settings_.costmap;
  const double reach_m = costmap_.footprint().inscribed_radius_m() + costmap.safety_margin_m + costmap.route_margin_m +
                         2.0 * costmap.resolution_m;
  const double to_m = std::min(path_.length_m(), along_m_ + settings_.check_ahead_m);
  for (double along_m = along_m_; along_m < to_m; along_m += costmap.resolution_m) {
    const Eigen::Vector2d p_map = path_.point_at(along_m);
    if (costmap_.cost_at(p_map) != kLethalCost) continue;
    const std::optional<Time> since = costmap_.live_since(p_map, reach_m);
    if (!since || now - *since >= from_seconds(settings_.detour_after_s)) return false;
  }
  return true;
}

/// Begins to look for a route when there is none, or none that is good for long.
void Navigator::search_if_needed(Time now, const Pose2& T_map_body) {
  bool is_blocked = false;
  if (!path_.is_empty()) {
    const PathProjection here =
        path_.project(T_map_body.position(), std::max(0.0, along_m_ - 0.5), along_m_ + 2.0);
    along_m_ = here.along_m;
    is_blocked = is_path_blocked(along_m_);
    if (is_blocked && settings_.detour_after_s > 0.0 && is_blocked_by_newcomer(now)) return;
    const bool is_old = map_is_new_ && now - planned_at_ >= from_seconds(settings_.replan_period_s);
    if (!is_blocked && !is_old && here.distance_m <= settings_.stray_m) return;
  }
  // An unsolvable search is the dearest one: not at every step.
  if (search_ || (planned_at_ != Time::min() && now - planned_at_ < from_seconds(0.5))) return;
  planned_at_ = now;
  map_is_new_ = false;
  costmap_.include(T_map_body.position(), 5.0);
  costmap_.include(goal_->T_map_body.position(), 5.0);
  PlanResult found = planner_.plan(costmap_.cost(), T_map_body.position(), goal_->T_map_body.position());
  const Time takes = from_seconds(static_cast<double>(found.num_expanded) / settings_.steps_per_s);
  search_ = Search{.found = std::move(found), .ready = now + (takes < kAtOnce ? Time{} : takes), .is_detour = is_blocked};
}

/// Takes the route that was looked for, once the robot's computer would have it.
void Navigator::take_route(Time now, const Pose2& T_map_body, NavigationStep& step) {
  if (!search_ || now < search_->ready) return;
  const Search search = *std::exchange(search_, std::nullopt);
  if (search.found.status != PlanStatus::kFound) {
    if (search.is_detour) path_ = {};
    if (path_.is_empty()) note_no_route(now, trouble_of(search.found.status));
    return;
  }
  no_route_since_.reset();
  trouble_ = NavigationTrouble::kNone;
  path_ = PlannedPath(search.found.points_m);
  along_m_ = path_.project(T_map_body.position(), 0.0, path_.length_m()).along_m;
  step.replanned = true;
  step.is_detour = search.is_detour;
  step.path = path_.sample(kPathStep_m);
}

void Navigator::note_no_route(Time now, NavigationTrouble trouble) {
  if (!no_route_since_) no_route_since_ = now;
  say(trouble);
}

/// A differential approach, once begun, says itself when it is done: it aims at less than the tolerances.
bool Navigator::is_at_goal(const Pose2& T_map_body) const {
  return is_approaching_ ? approach_.is_done() : is_reached(T_map_body, *goal_);
}

NavigationStatus Navigator::drive(Time now, const Pose2& T_map_body, VelocityCommand& command) {
  const double goal_distance_m = (goal_->T_map_body.position() - T_map_body.position()).norm();
  if (settings_.drive == "differential") {
    const bool is_end_of_path = path_.length_m() - along_m_ <= settings_.approach_m;
    const double room_m = settings_.differential_approach.max_back_off_m;
    if (!is_approaching_) approach_.reset();
    is_approaching_ = is_approaching_ ? goal_distance_m <= settings_.approach_m + room_m
                                      : goal_distance_m <= settings_.approach_m && is_end_of_path;
    if (is_approaching_) return approach(now, T_map_body, command);
  }
  const VelocityCommand straight = regulate_pose(settings_.approach, T_map_body, *goal_);
  const bool is_near = settings_.drive != "differential" && goal_distance_m <= settings_.approach_m;
  command = is_near && is_safe(T_map_body, straight, 0.5) ? straight : follow_path(T_map_body);
  note_progress(T_map_body);
  if (stands_still(command) && !is_near) return stand_blocked(now, T_map_body, command);
  blocked_since_.reset();
  return NavigationStatus::kDriving;
}

/// The last metre of a differential robot. Where there is no room for it, it looks for another way in, then recovers.
NavigationStatus Navigator::approach(Time now, const Pose2& T_map_body, VelocityCommand& command) {
  note_progress(T_map_body);
  command = approach_.step(T_map_body, *goal_);
  if (!is_safe(T_map_body, command, 0.5)) {
    approach_.block();
    return stand_blocked(now, T_map_body, command);
  }
  blocked_since_.reset();
  return NavigationStatus::kDriving;
}

VelocityCommand Navigator::follow_path(const Pose2& T_map_body) {
  VelocityCommand command;
  if (turn_in_place(T_map_body, command)) return command;
  const double left_m = std::max(0.0, path_.length_m() - along_m_);
  double speed_limit = std::max(kMinApproachSpeed_mps, std::sqrt(2.0 * settings_.approach_decel_mps2 * left_m));
  if (is_newcomer_ahead(T_map_body)) speed_limit = std::min(speed_limit, settings_.newcomer_speed_mps);
  return local_planner_->choose(costmap_, path_, along_m_, T_map_body, twist_of(last_), speed_limit).value_or(VelocityCommand{});
}

bool Navigator::is_newcomer_ahead(const Pose2& T_map_body) const {
  if (settings_.newcomer_distance_m <= 0.0) return false;
  const double reach_m = settings_.newcomer_distance_m / 2.0;
  const Eigen::Vector2d p_map_ahead = T_map_body * Eigen::Vector2d(reach_m, 0.0);
  return costmap_.live_since(p_map_ahead, reach_m).has_value();
}

/// Whether the path leads off so far to the side that the robot should turn before it walks.
bool Navigator::turn_in_place(const Pose2& T_map_body, VelocityCommand& command) const {
  const Eigen::Vector2d ahead = path_.point_at(along_m_ + 0.5) - T_map_body.position();
  if (ahead.norm() < 0.1) return false;
  const double turn = wrap_angle(std::atan2(ahead.y(), ahead.x()) - T_map_body.yaw);
  const bool is_turning = std::abs(last_.yaw_rate_radps) > 0.3 && std::abs(last_.vx_mps) < 0.01;
  if (std::abs(turn) < (is_turning ? 0.35 : settings_.turn_first_rad)) return false;
  command.yaw_rate_radps = std::copysign(settings_.turn_rate_radps, turn);
  if (is_safe(T_map_body, command, 0.6)) return true;
  command = {};
  return false;
}

/// Stands until there is a first route.
NavigationStatus Navigator::think(Time now) {
  blocked_since_.reset();
  if (stay_) stay_->since = now;
  return NavigationStatus::kDriving;
}

/// Waits; recovers when that has lasted.
NavigationStatus Navigator::stand_blocked(Time now, const Pose2& T_map_body, VelocityCommand& command) {
  command = {};
  if (!blocked_since_) blocked_since_ = now;
  if (now - *blocked_since_ < from_seconds(settings_.patience_s)) return NavigationStatus::kBlocked;
  if (!no_route_since_) say(NavigationTrouble::kPathBlocked);
  return recover(now, T_map_body, command);
}

/// Whether the robot moves and gets nowhere, as before a goal that its outline does not quite fit.
bool Navigator::is_stuck(Time now, const Pose2& T_map_body) {
  if (!stay_ || (T_map_body.position() - stay_->p_map).norm() > kProgress_m) stay_ = Stay{T_map_body.position(), now};
  return now - stay_->since > from_seconds(settings_.stuck_s);
}

/// Begins the next recovery.
NavigationStatus Navigator::recover(Time now, const Pose2& T_map_body, VelocityCommand& command) {
  command = {};
  search_.reset();
  blocked_since_.reset();
  stay_.reset();
  is_approaching_ = false;
  const std::string& kind = settings_.recoveries[static_cast<std::size_t>(recoveries_) % settings_.recoveries.size()];
  ++recoveries_;
  recovery_text_ = sentence_of_recovery(kind);
  if (kind != "wait") costmap_.forget_live(T_map_body.position(), 2.0);
  double duration_s = 0.0;  // clear: nothing more
  if (kind == "back_up") duration_s = settings_.back_up_s;
  if (kind == "wait") duration_s = settings_.patience_s;
  if (kind == "look_around") duration_s = kTurnPatience * 2.0 * std::numbers::pi / settings_.turn_rate_radps;
  recovery_ = Recovery{.kind = kind, .until = now + from_seconds(duration_s), .yaw_before = T_map_body.yaw};
  return NavigationStatus::kRecovering;
}

/// Ends with its time, when it is done, or where there is no room for it; then a new path is looked for.
NavigationStatus Navigator::carry_on_recovery(Time now, const Pose2& T_map_body, VelocityCommand& command) {
  recovery_->turned_rad += std::abs(wrap_angle(T_map_body.yaw - recovery_->yaw_before));
  recovery_->yaw_before = T_map_body.yaw;
  if (recovery_->kind == "back_up") command.vx_mps = -settings_.back_up_speed_mps;
  if (recovery_->kind == "look_around") command.yaw_rate_radps = settings_.turn_rate_radps;
  const bool is_done = now >= recovery_->until || recovery_->turned_rad >= 2.0 * std::numbers::pi;
  if (!is_done && is_safe(T_map_body, command, 1.0)) return NavigationStatus::kRecovering;
  recovery_.reset();
  path_ = {};
  command = {};
  return NavigationStatus::kRecovering;
}

/// Whether the robot can move like that for a time without touching anything, or at least without coming nearer to it.
bool Navigator::is_safe(const Pose2& T_map_body, const VelocityCommand& command, double time_s) const {
  const double clearance_now = costmap_.clearance_m(T_map_body);
  for (const double part : {0.25, 0.5, 0.75, 1.0}) {
    const Pose2 there = T_map_body * Pose2{command.vx_mps * time_s * part, command.vy_mps * time_s * part,
                                           command.yaw_rate_radps * time_s * part};
    if (costmap_.clearance_m(there) < std::min(kMinPassable_m, clearance_now)) return false;
  }
  return true;
}

void Navigator::note_progress(const Pose2& T_map_body) {
  const double left_m = (goal_->T_map_body.position() - T_map_body.position()).norm() + path_.length_m() - along_m_;
  if (left_m > nearest_left_m_ - kProgress_m) return;
  nearest_left_m_ = left_m;
  recoveries_ = 0;
}

}  // namespace patrol::plan
