#include "plan/navigation/navigator.h"

#include <cmath>
#include <utility>

#include "core/wheel_kinematics.h"
#include "plan/control/pose_regulator.h"
#include "plan/navigation/maneuver_follower.h"
#include "plan/navigation/motion_check.h"
#include "plan/navigation/path_follower.h"

namespace patrol::plan {
namespace {

constexpr double kPathStep_m = 0.25;  // spacing of the poses of the published path
constexpr double kLookAhead_s = 0.5;  // time for which a command of the approach must be safe

bool is_stationary(const VelocityCommand& command) {
  return std::abs(command.vx_mps) < 0.03 && std::abs(command.vy_mps) < 0.03 && std::abs(command.yaw_rate_radps) < 0.05;
}

const NavigatorSettings& checked(const NavigatorSettings& settings) {
  validate(settings, "navigation");
  return settings;
}

std::optional<ManeuverPlanner> maneuver_planner(const NavigatorSettings& settings, const RobotDescription& robot) {
  if (settings.kinematics != "ackermann") return std::nullopt;
  return ManeuverPlanner(settings.maneuver_planner, robot);
}

std::unique_ptr<RouteFollower> make_follower(const NavigatorSettings& settings, const RobotDescription& robot) {
  const std::optional<ManeuverPlanner> maneuvers = maneuver_planner(settings, robot);
  if (!maneuvers) return std::make_unique<PathFollower>(settings);
  return std::make_unique<ManeuverFollower>(settings, maneuvers->T_body_center(), 1.0 / min_turning_radius_m(robot));
}

}  // namespace

Navigator::Navigator(const NavigatorSettings& settings, const RobotDescription& robot,
                     std::vector<Polyline> keep_out_lines_in_map, std::uint64_t seed)
    : settings_(checked(settings)),
      robot_(robot),
      costmap_(settings.costmap, Footprint(robot.footprint_m, settings.footprint_rows),
               std::move(keep_out_lines_in_map)),
      search_(settings, seed, maneuver_planner(settings, robot)),
      follower_(make_follower(settings, robot)),
      approach_(settings.goal_controller.differential),
      recoveries_(settings),
      progress_(settings.no_progress_timeout_s) {}

void Navigator::set_map(const OccupancyGrid& map) {
  costmap_.set_map(map);
  search_.on_new_map();
}

void Navigator::set_keep_out_lines(std::vector<Polyline> lines_in_map) {
  costmap_.set_keep_out_lines(std::move(lines_in_map));
  search_.on_new_map();
}

void Navigator::add_depth(const DepthImage& image, const Pose3& T_level_body, const Pose2& T_map_body) {
  const Pose3 T_level_camera = T_level_body * robot_.T_body("depth_camera");
  costmap_.add_image(segment_obstacles(settings_.depth_obstacles, image, T_level_camera, robot_.body_height_m()),
                     image.stamp, T_map_body);
}

void Navigator::add_range(const UltrasonicRange& ping, const Pose3& T_level_body, const Pose2& T_map_body) {
  const Pose3 T_level_transducer = T_level_body * robot_.T_body("ultrasonic_" + std::to_string(ping.transducer));
  const SonarCone cone = inverse_sonar_model(settings_.sonar_obstacles, ping, T_level_transducer,
                                             robot_.body_height_m(), settings_.costmap.resolution_m);
  costmap_.add_ping(cone, ping.stamp, T_map_body);
}

void Navigator::set_goal(const std::optional<NavigationGoal>& goal) {
  if (goal == goal_) return;
  goal_ = goal;
  state_ = goal ? State::kFollowing : State::kIdle;
  follower_->clear();
  search_.reset();
  recoveries_.reset();
  progress_.reset();
  blocked_since_.reset();
  no_path_since_.reset();
  failure_ = NavigationFailure::kNone;
  text_.clear();
  recovery_text_.clear();
}

NavigationStep Navigator::step(Time now, const Pose2& T_map_body) {
  NavigationStep step;
  if (goal_) {
    check_end(now, T_map_body);
    step.status = act(now, T_map_body, step);
  }
  step.failure = failure_;
  step.text = std::exchange(text_, {});
  step.recovery = std::exchange(recovery_text_, {});
  last_ = step.command;
  return step;
}

NavigationStatus Navigator::act(Time now, const Pose2& T_map_body, NavigationStep& step) {
  switch (state_) {
    case State::kIdle:
      return NavigationStatus::kIdle;
    case State::kArrived:
      return NavigationStatus::kArrived;
    case State::kFailed:
      return NavigationStatus::kFailed;
    case State::kRecovering:
      return continue_recovery(now, T_map_body, step.command);
    case State::kFollowing:
    case State::kApproaching:
      break;
  }
  return navigate(now, T_map_body, step);
}

/// Enters kArrived at the goal, or kFailed when the goal is aborted.
void Navigator::check_end(Time now, const Pose2& T_map_body) {
  if (state_ == State::kArrived) return;
  if (is_at_goal(T_map_body)) {
    state_ = State::kArrived;
    failure_ = NavigationFailure::kNone;
  } else if (state_ != State::kFailed && must_abort(now)) {
    state_ = State::kFailed;
    text_ = std::string("Navigation aborted: ") + describe(failure_);
  }
}

/// An active differential approach determines its own completion: it aims at less than the tolerances.
bool Navigator::is_at_goal(const Pose2& T_map_body) const {
  return state_ == State::kApproaching ? approach_.is_done() : is_reached(T_map_body, *goal_);
}

bool Navigator::must_abort(Time now) const {
  return recoveries_.is_exhausted() ||
         (no_path_since_ && now - *no_path_since_ > from_seconds(settings_.no_path_timeout_s));
}

void Navigator::report(NavigationFailure failure) {
  if (failure != failure_) text_ = describe(failure);
  failure_ = failure;
}

NavigationStatus Navigator::navigate(Time now, const Pose2& T_map_body, NavigationStep& step) {
  if (progress_.is_stuck(now, T_map_body)) {
    report(NavigationFailure::kNoProgress);
    return begin_recovery(now, T_map_body, step.command);
  }
  search_if_needed(now, T_map_body);
  take_route(now, T_map_body, step);
  if (follower_->has_path()) return drive(now, T_map_body, step.command);
  if (search_.is_running()) return wait_for_route(now);
  return wait_blocked(now, T_map_body, step.command);
}

/// Begins a route search if there is no path, or the path is outdated, blocked, or too far from the robot.
void Navigator::search_if_needed(Time now, const Pose2& T_map_body) {
  bool is_blocked = false;
  if (follower_->has_path()) {
    const double path_deviation_m = follower_->advance(T_map_body);
    is_blocked = follower_->is_blocked(costmap_);
    if (is_blocked && settings_.new_obstacle_wait_s > 0.0 && follower_->is_blocked_by_new_obstacles_only(costmap_, now))
      return;
    const bool is_outdated = search_.is_outdated(now) && follower_->may_be_replaced(costmap_);
    const bool is_off = path_deviation_m > settings_.max_path_deviation_m || follower_->has_ended();
    if (!is_blocked && !is_outdated && !is_off) return;
  }
  if (!search_.may_begin(now, T_map_body)) return;
  search_.begin(now, costmap_, T_map_body, *goal_, is_blocked, last_.vx_mps < 0.0);
}

/// Takes the route of a completed search.
void Navigator::take_route(Time now, const Pose2& T_map_body, NavigationStep& step) {
  const std::optional<RouteSearch::Result> result = search_.take(now);
  if (!result) return;
  if (result->route.status != PlanStatus::kFound) {
    if (result->is_detour) follower_->clear();
    if (follower_->has_path()) return;
    if (!no_path_since_) no_path_since_ = now;
    report(to_failure(result->route.status));
    return;
  }
  no_path_since_.reset();
  failure_ = NavigationFailure::kNone;
  follower_->set_route(result->route, T_map_body);
  step.replanned = true;
  step.is_detour = result->is_detour;
  step.path = follower_->path().sample(kPathStep_m);
}

NavigationStatus Navigator::drive(Time now, const Pose2& T_map_body, VelocityCommand& command) {
  const bool is_differential = settings_.kinematics == "differential";
  const double goal_distance_m = (goal_->T_map_body.position() - T_map_body.position()).norm();
  if (is_differential) choose_approach(goal_distance_m);
  if (state_ == State::kApproaching) return approach(now, T_map_body, command);

  const VelocityCommand straight = regulate_pose(settings_.goal_controller.holonomic, T_map_body, *goal_);
  const bool is_near =
      settings_.kinematics == "omnidirectional" && goal_distance_m <= settings_.goal_approach_distance_m;
  const bool is_straight = is_near && is_motion_safe(costmap_, T_map_body, straight, kLookAhead_s);
  command = is_straight ? straight : follower_->command(costmap_, T_map_body, last_);
  update_progress(T_map_body);
  if (is_stationary(command) && !is_near) return wait_blocked(now, T_map_body, command);
  blocked_since_.reset();
  return NavigationStatus::kDriving;
}

/// Activates the differential approach at the end of the path; it stays active when the robot backs off from the goal.
void Navigator::choose_approach(double goal_distance_m) {
  const bool was_approaching = state_ == State::kApproaching;
  if (!was_approaching) approach_.reset();
  const bool is_approaching = was_approaching
                                  ? goal_distance_m <= settings_.goal_approach_distance_m +
                                                           settings_.goal_controller.differential.max_back_off_m
                                  : goal_distance_m <= settings_.goal_approach_distance_m &&
                                        follower_->remaining_m() <= settings_.goal_approach_distance_m;
  state_ = is_approaching ? State::kApproaching : State::kFollowing;
}

/// Drives the last meter of a differential robot. When blocked, it tries the other side, then begins a recovery.
NavigationStatus Navigator::approach(Time now, const Pose2& T_map_body, VelocityCommand& command) {
  update_progress(T_map_body);
  command = approach_.step(T_map_body, *goal_);
  if (!is_motion_safe(costmap_, T_map_body, command, kLookAhead_s)) {
    approach_.block();
    return wait_blocked(now, T_map_body, command);
  }
  blocked_since_.reset();
  return NavigationStatus::kDriving;
}

/// Stops until the search is completed. After a search without a route, the time of the next ones counts as blocked.
NavigationStatus Navigator::wait_for_route(Time now) {
  if (!no_path_since_) blocked_since_.reset();
  progress_.restart_time(now);
  return NavigationStatus::kDriving;
}

/// Stops; begins a recovery after `blocked_timeout_s`.
NavigationStatus Navigator::wait_blocked(Time now, const Pose2& T_map_body, VelocityCommand& command) {
  command = {};
  if (!blocked_since_) blocked_since_ = now;
  if (now - *blocked_since_ < from_seconds(settings_.blocked_timeout_s)) return NavigationStatus::kBlocked;
  if (!no_path_since_) report(NavigationFailure::kPathBlocked);
  return begin_recovery(now, T_map_body, command);
}

NavigationStatus Navigator::begin_recovery(Time now, const Pose2& T_map_body, VelocityCommand& command) {
  command = {};
  search_.cancel();
  blocked_since_.reset();
  progress_.restart();
  recovery_text_ = recoveries_.begin_next(now, T_map_body, costmap_);
  state_ = State::kRecovering;
  return NavigationStatus::kRecovering;
}

/// Runs the recovery; searches a new path when it is completed.
NavigationStatus Navigator::continue_recovery(Time now, const Pose2& T_map_body, VelocityCommand& command) {
  if (const std::optional<VelocityCommand> recovery = recoveries_.step(now, T_map_body, costmap_)) {
    command = *recovery;
  } else {
    follower_->clear();
    state_ = State::kFollowing;
  }
  return NavigationStatus::kRecovering;
}

void Navigator::update_progress(const Pose2& T_map_body) {
  const double goal_distance_m = (goal_->T_map_body.position() - T_map_body.position()).norm();
  if (progress_.has_progressed(goal_distance_m + follower_->path().length_m() - follower_->along_m()))
    recoveries_.reset();
}

}  // namespace patrol::plan
