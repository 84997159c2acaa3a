#include "plan/navigator.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace patrol::plan {
namespace {

constexpr double kPathStep_m = 0.25;          // poses of the published path
constexpr double kProgress_m = 0.5;           // that much nearer counts as getting on
constexpr double kMinApproachSpeed_mps = 0.15;
constexpr double kMinPassable_m = 0.02;       // of a turn in place

Twist3 twist_of(const VelocityCommand& command) {
  return {.linear = {command.vx_mps, command.vy_mps, 0.0}, .angular = {0.0, 0.0, command.yaw_rate_radps}};
}

/// Of the body's origin above the ground. Robots on legs have no sensors that ask for it.
double body_height_m(const RobotDescription& robot) { return robot.tracks ? robot.tracks->body_height_m : 0.0; }

bool stands_still(const VelocityCommand& command) {
  return std::abs(command.vx_mps) < 0.03 && std::abs(command.vy_mps) < 0.03 && std::abs(command.yaw_rate_radps) < 0.05;
}

}  // namespace

Navigator::Navigator(const NavigatorSettings& settings, const RobotDescription& robot,
                     std::vector<Polyline> keep_out_lines_in_map)
    : settings_(settings),
      robot_(robot),
      costmap_(settings.costmap, Footprint(robot.footprint_m, settings.footprint_rows), std::move(keep_out_lines_in_map)),
      planner_(settings.global),
      window_(settings.local),
      approach_(settings.differential_approach) {
  validate(settings, "navigation");
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
  planned_at_ = Time::min();
  blocked_since_.reset();
  stay_.reset();
  backing_until_.reset();
  recoveries_ = 0;
  nearest_left_m_ = std::numeric_limits<double>::infinity();
}

NavigationStep Navigator::step(Time now, const Pose2& T_map_body) {
  NavigationStep step;
  if (goal_) {
    if (has_arrived_ || is_at_goal(T_map_body)) {
      has_arrived_ = true;
      step.status = NavigationStatus::kArrived;
    } else if (recoveries_ > settings_.max_recoveries) {
      step.status = NavigationStatus::kFailed;
    } else if (!backing_until_ && is_stuck(now, T_map_body)) {
      step.status = recover(now, T_map_body, step.command);
    } else if (backing_until_ || plan_if_needed(now, T_map_body, step)) {
      step.status = drive(now, T_map_body, step.command);
    } else {
      step.status = stand_blocked(now, T_map_body, step.command);
    }
  }
  last_ = step.command;
  return step;
}

/// Whether something stands on the path within `check_ahead_m`.
bool Navigator::is_path_blocked(double from_m) const {
  const double to_m = std::min(path_.length_m(), from_m + settings_.check_ahead_m);
  for (double along_m = from_m; along_m < to_m; along_m += costmap_.settings().resolution_m) {
    if (costmap_.cost_at(path_.point_at(along_m)) == kLethalCost) return true;
  }
  return false;
}

/// False if there is no path.
bool Navigator::plan_if_needed(Time now, const Pose2& T_map_body, NavigationStep& step) {
  bool is_blocked = false;
  if (!path_.is_empty()) {
    const PathProjection here =
        path_.project(T_map_body.position(), std::max(0.0, along_m_ - 0.5), along_m_ + 2.0);
    along_m_ = here.along_m;
    is_blocked = is_path_blocked(along_m_);
    const bool is_old = map_is_new_ && now - planned_at_ >= from_seconds(settings_.replan_period_s);
    if (!is_blocked && !is_old && here.distance_m <= settings_.stray_m) return true;
  }
  // An unsolvable search is the dearest one: not at every step.
  if (planned_at_ != Time::min() && now - planned_at_ < from_seconds(0.5)) return !path_.is_empty();
  planned_at_ = now;
  map_is_new_ = false;
  costmap_.include(T_map_body.position(), 5.0);
  costmap_.include(goal_->T_map_body.position(), 5.0);
  const PlanResult plan = planner_.plan(costmap_.cost(), T_map_body.position(), goal_->T_map_body.position());
  if (plan.status != PlanStatus::kFound) {
    if (is_blocked) path_ = {};
    return !path_.is_empty();
  }
  path_ = PlannedPath(shortcut(costmap_.cost(), settings_.global.cost_weight, plan.points_m));
  along_m_ = 0.0;
  step.replanned = true;
  step.is_detour = is_blocked;
  step.path = path_.sample(kPathStep_m);
  return true;
}

/// A differential approach, once begun, says itself when it is done: it aims at less than the tolerances.
bool Navigator::is_at_goal(const Pose2& T_map_body) const {
  return is_approaching_ ? approach_.is_done() : is_reached(T_map_body, *goal_);
}

NavigationStatus Navigator::drive(Time now, const Pose2& T_map_body, VelocityCommand& command) {
  if (backing_until_) {
    command.vx_mps = -settings_.back_up_speed_mps;
    if (now < *backing_until_ && is_safe(T_map_body, command, 1.0)) return NavigationStatus::kRecovering;
    backing_until_.reset();
    path_ = {};
    command = {};
    return NavigationStatus::kRecovering;
  }
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
  const double speed_limit = std::max(kMinApproachSpeed_mps, std::sqrt(2.0 * settings_.approach_decel_mps2 * left_m));
  return window_.choose(costmap_, path_, along_m_, T_map_body, twist_of(last_), speed_limit).value_or(VelocityCommand{});
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

/// Waits; recovers when that has lasted.
NavigationStatus Navigator::stand_blocked(Time now, const Pose2& T_map_body, VelocityCommand& command) {
  command = {};
  if (!blocked_since_) blocked_since_ = now;
  if (now - *blocked_since_ < from_seconds(settings_.patience_s)) return NavigationStatus::kBlocked;
  return recover(now, T_map_body, command);
}

/// Whether the robot moves and gets nowhere, as before a goal that its outline does not quite fit.
bool Navigator::is_stuck(Time now, const Pose2& T_map_body) {
  if (!stay_ || (T_map_body.position() - stay_->p_map).norm() > kProgress_m) stay_ = Stay{T_map_body.position(), now};
  return now - stay_->since > from_seconds(settings_.stuck_s);
}

/// Backs up and looks for another way.
NavigationStatus Navigator::recover(Time now, const Pose2& T_map_body, VelocityCommand& command) {
  command = {};
  blocked_since_.reset();
  stay_.reset();
  is_approaching_ = false;
  ++recoveries_;
  costmap_.forget_live(T_map_body.position(), 2.0);
  backing_until_ = now + from_seconds(settings_.back_up_s);
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
