#include "plan/maneuvers/maneuver_planner.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <queue>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "core/wheel_kinematics.h"
#include "plan/maneuvers/dubins.h"
#include "plan/maneuvers/goal_distance.h"

namespace patrol::plan {
namespace {

constexpr double kPoseStep_m = 0.1;    // spacing of checked and returned poses
constexpr double kCell_m = 0.25;       // positions closer than this are one state
constexpr int kNumHeadings = 72;       // headings within 5 degrees are one state
constexpr int kShotPeriod = 8;         // one of this many expanded states tries to reach the goal by a Dubins path
constexpr double kNear_m = 12.0;       // distance from the goal within which every state tries
constexpr double kNearEnd_m = 2.0;     // distance from start or goal within which the clearance of that end is enough
constexpr double kTolerance_m = 0.01;  // loss of that clearance by interpolation and by the swing of the rear
constexpr int kNoParent = -1;

struct State {
  Pose2 T_map_center;
  bool is_reverse = false;
  double cost_m = 0.0;
  int parent = kNoParent;
  Arc arc;  ///< from the parent
  bool is_closed = false;
};

/// A path to the exact goal from a state: arcs in one direction.
struct Shot {
  int from = kNoParent;
  bool is_reverse = false;
  std::vector<Arc> arcs;
  double cost_m = std::numeric_limits<double>::infinity();
};

/// Start or goal.
struct End {
  Eigen::Vector2d p_map_center;
  double min_clearance_m = 0.0;  ///< clearance that suffices near this end
};

bool is_near_end(const Pose2& T_map_center, const End& end) {
  return (T_map_center.position() - end.p_map_center).norm() < kNearEnd_m;
}

std::uint64_t key_of(const Pose2& pose, bool is_reverse) {
  const auto cell = [](double value_m) { return static_cast<std::int64_t>(std::floor(value_m / kCell_m)); };
  const double turns = pose.yaw / (2.0 * std::numbers::pi);
  const auto heading = static_cast<std::int64_t>(std::floor((turns - std::floor(turns)) * kNumHeadings));
  const auto x = static_cast<std::uint64_t>(cell(pose.x) + (1 << 20)),
             y = static_cast<std::uint64_t>(cell(pose.y) + (1 << 20));
  return (((x << 22U) | y) << 8U) | (static_cast<std::uint64_t>(heading) << 1U) | (is_reverse ? 1U : 0U);
}

/// One search.
class Search {
 public:
  Search(const ManeuverPlannerSettings& settings, const Costmap& costmap, const Pose2& T_center_body, double radius_m,
         const Pose2& T_map_start, const Pose2& T_map_goal)
      : settings_(settings),
        costmap_(costmap),
        T_center_body_(T_center_body),
        radius_m_(radius_m),
        T_map_goal_(T_map_goal),
        ends_{start_end(T_map_start), goal_end(T_map_goal)} {}

  ManeuverResult run(const Pose2& T_map_start, bool is_reversing);

 private:
  double clearance_m(const Pose2& T_map_center) const { return costmap_.clearance_m(T_map_center * T_center_body_); }
  /// Below that of a safe motion, the robot cannot reduce its clearance.
  End start_end(const Pose2& T_map_center) const {
    const double here_m = clearance_m(T_map_center);
    return {T_map_center.position(), std::min(here_m, std::max(kMinPassable_m, here_m - kTolerance_m))};
  }
  End goal_end(const Pose2& T_map_center) const {
    return {T_map_center.position(), std::max(0.0, clearance_m(T_map_center) - kTolerance_m)};
  }
  /// Returns whether the clearance exceeds the route margin, or suffices near start or goal.
  bool is_free(const Pose2& T_map_center) const {
    if (costmap_.is_clear(T_map_center * T_center_body_, costmap_.settings().route_margin_m)) return true;
    return std::ranges::any_of(ends_, [&](const End& end) {
      return is_near_end(T_map_center, end) && clearance_m(T_map_center) >= end.min_clearance_m;
    });
  }
  std::optional<double> cost_of(const Pose2& T_map_from, const Arc& arc, bool is_reverse) const;
  void add(const Pose2& T_map_center, bool is_reverse, double cost_m, int parent, const Arc& arc);
  void expand(int index);
  void shoot(int index);
  Maneuver trace(const Shot& shot) const;

  const ManeuverPlannerSettings& settings_;
  const Costmap& costmap_;
  Pose2 T_center_body_;
  double radius_m_;
  Pose2 T_map_goal_;
  std::optional<GoalDistance> to_goal_;
  std::array<End, 2> ends_;
  std::vector<State> states_;
  std::unordered_map<std::uint64_t, int> known_;  ///< index of the best state with a key
  using Entry = std::pair<double, int>;           ///< estimated total cost, state
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open_;
  Shot best_;
};

/// Returns the cost of an arc; none if it is not free.
std::optional<double> Search::cost_of(const Pose2& T_map_from, const Arc& arc, bool is_reverse) const {
  const int steps = std::max(1, static_cast<int>(std::ceil(arc.length_m / kPoseStep_m - 1e-9)));
  const double step_m = arc.length_m / steps, direction = is_reverse ? -1.0 : 1.0;
  double cost_m = 0.0;
  for (int step = 1; step <= steps; ++step) {
    const Pose2 pose = along_arc(T_map_from, direction * arc.curvature_per_m, direction * step * step_m);
    if (!is_free(pose)) return std::nullopt;
    cost_m += step_m * travel_weight(costmap_, pose.position(), settings_.cost_weight);
  }
  return (is_reverse ? settings_.reverse_weight : 1.0) * cost_m;
}

void Search::add(const Pose2& T_map_center, bool is_reverse, double cost_m, int parent, const Arc& arc) {
  double remaining_m = to_goal_->at(T_map_center.position());
  if (!std::isfinite(remaining_m)) {
    if (!is_near_end(T_map_center, ends_.front())) return;
    // Cells around a start in collision are lethal: they have no distance, but the robot may leave them.
    remaining_m = (T_map_center.position() - T_map_goal_.position()).norm();
  }
  const auto [known, is_new] = known_.try_emplace(key_of(T_map_center, is_reverse), static_cast<int>(states_.size()));
  if (!is_new) {
    if (states_[static_cast<std::size_t>(known->second)].cost_m <= cost_m) return;
    states_[static_cast<std::size_t>(known->second)].is_closed = true;  // replaced
    known->second = static_cast<int>(states_.size());
  }
  states_.push_back(
      {.T_map_center = T_map_center, .is_reverse = is_reverse, .cost_m = cost_m, .parent = parent, .arc = arc});
  open_.emplace(cost_m + settings_.greediness * remaining_m, static_cast<int>(states_.size()) - 1);
}

void Search::expand(int index) {
  const State from = states_[static_cast<std::size_t>(index)];
  for (const bool is_reverse : {false, true}) {
    const double change_m = is_reverse != from.is_reverse ? settings_.direction_change_m : 0.0;
    const double direction = is_reverse ? -1.0 : 1.0;
    for (const double part : {0.0, 0.5, -0.5, 1.0, -1.0}) {
      const Arc arc{.curvature_per_m = part / radius_m_, .length_m = settings_.step_m};
      const std::optional<double> cost_m = cost_of(from.T_map_center, arc, is_reverse);
      if (!cost_m) continue;
      const Pose2 to = along_arc(from.T_map_center, direction * arc.curvature_per_m, direction * arc.length_m);
      add(to, is_reverse, from.cost_m + change_m + *cost_m, index, arc);
    }
  }
}

/// Tries to reach the goal by a Dubins path, forward and backward.
void Search::shoot(int index) {
  const State& from = states_[static_cast<std::size_t>(index)];
  const Pose2 T_from_goal = from.T_map_center.inverse() * T_map_goal_;
  for (const bool is_reverse : {false, true}) {
    // To a robot that looks backward, the goal is on the other side, with the same turn.
    const Pose2 goal = is_reverse ? Pose2{-T_from_goal.x, -T_from_goal.y, T_from_goal.yaw} : T_from_goal;
    Shot shot{.from = index, .is_reverse = is_reverse, .arcs = dubins_path(goal, radius_m_), .cost_m = from.cost_m};
    if (is_reverse != from.is_reverse) shot.cost_m += settings_.direction_change_m;
    Pose2 pose = from.T_map_center;
    bool is_possible = true;
    for (const Arc& arc : shot.arcs) {
      const std::optional<double> cost_m = cost_of(pose, arc, is_reverse);
      is_possible = cost_m && shot.cost_m + *cost_m < best_.cost_m;
      if (!is_possible) break;
      shot.cost_m += *cost_m;
      const double direction = is_reverse ? -1.0 : 1.0;
      pose = along_arc(pose, direction * arc.curvature_per_m, direction * arc.length_m);
    }
    if (is_possible) best_ = std::move(shot);
  }
}

ManeuverResult Search::run(const Pose2& T_map_start, bool is_reversing) {
  to_goal_.emplace(costmap_.cost(), T_map_goal_.position(), settings_.cost_weight);
  ManeuverResult result{.num_cells = to_goal_->num_expanded()};
  add(T_map_start, is_reversing, 0.0, kNoParent, {});
  const int max_expanded = 1000 * settings_.max_expanded_thousands;
  while (!open_.empty() && result.num_expanded < max_expanded) {
    const auto [estimate_m, index] = open_.top();
    open_.pop();
    State& state = states_[static_cast<std::size_t>(index)];
    if (state.is_closed) continue;
    if (estimate_m >= best_.cost_m) break;
    state.is_closed = true;
    const bool is_near = (state.T_map_center.position() - T_map_goal_.position()).norm() < kNear_m;
    if (is_near || result.num_expanded % kShotPeriod == 0) shoot(index);
    expand(index);
    ++result.num_expanded;
  }
  if (best_.from == kNoParent) {
    result.status = open_.empty() ? PlanStatus::kNoRoute : PlanStatus::kNotFound;
    return result;
  }
  result.status = PlanStatus::kFound;
  result.maneuver = trace(best_);
  result.cost_m = best_.cost_m;
  return result;
}

Maneuver Search::trace(const Shot& shot) const {
  std::vector<std::pair<Arc, bool>> parts;  // arc, whether in reverse
  for (const Arc& arc : shot.arcs) parts.emplace_back(arc, shot.is_reverse);
  std::reverse(parts.begin(), parts.end());
  int at = shot.from;
  for (; states_[static_cast<std::size_t>(at)].parent != kNoParent; at = states_[static_cast<std::size_t>(at)].parent)
    parts.emplace_back(states_[static_cast<std::size_t>(at)].arc, states_[static_cast<std::size_t>(at)].is_reverse);
  std::reverse(parts.begin(), parts.end());

  Pose2 pose = states_[static_cast<std::size_t>(at)].T_map_center;
  Maneuver maneuver = {{.T_map_center = pose, .is_reverse = parts.empty() ? shot.is_reverse : parts.front().second}};
  double along_m = 0.0;
  for (const auto& [arc, is_reverse] : parts) {
    if (arc.length_m < 1e-9) continue;
    const int steps = std::max(1, static_cast<int>(std::ceil(arc.length_m / kPoseStep_m - 1e-9)));
    const double direction = is_reverse ? -1.0 : 1.0;
    for (int step = 1; step <= steps; ++step) {
      const double distance_m = arc.length_m * step / steps;
      maneuver.push_back({.T_map_center = along_arc(pose, direction * arc.curvature_per_m, direction * distance_m),
                          .curvature_per_m = arc.curvature_per_m,
                          .is_reverse = is_reverse,
                          .along_m = along_m + distance_m});
    }
    pose = maneuver.back().T_map_center;
    along_m += arc.length_m;
  }
  return maneuver;
}

/// Returns the heading at the goal of the shortest path from the start.
double arrival_heading(const Costmap& costmap, const Eigen::Vector2d& p_map_start, const Eigen::Vector2d& p_map_goal) {
  constexpr double kRing_m = 2.0;
  const Eigen::Vector2d direct = p_map_goal - p_map_start;
  if (direct.norm() < kRing_m) return std::atan2(direct.y(), direct.x());
  const GoalDistance to_start(costmap.cost(), p_map_start, 1.0);
  double best = std::atan2(direct.y(), direct.x()), shortest_m = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kNumHeadings; ++i) {
    const double heading = 2.0 * std::numbers::pi * i / kNumHeadings;
    const Eigen::Vector2d before = p_map_goal - kRing_m * Eigen::Vector2d(std::cos(heading), std::sin(heading));
    if (to_start.at(before) >= shortest_m) continue;
    shortest_m = to_start.at(before);
    best = heading;
  }
  return best;
}

const RobotDescription& steered(const RobotDescription& robot) {
  if (robot.wheels.empty() || wheel_drive_type(robot) != WheelDriveType::kAckermann)
    throw InputError(fmt::format("navigation.kinematics = ackermann: robot {} has no steered wheels", robot.name));
  return robot;
}

}  // namespace

double travel_weight(const Costmap& costmap, const Eigen::Vector2d& p_map, double cost_weight) {
  return 1.0 + cost_weight * std::min(costmap.cost_at(p_map), kMaxPassableCost) / kMaxPassableCost;
}

ManeuverPlanner::ManeuverPlanner(const ManeuverPlannerSettings& settings, const RobotDescription& robot)
    : settings_(settings),
      radius_m_(settings.radius_factor * min_turning_radius_m(steered(robot))),
      T_body_center_{differential_geometry(robot).middle_x_m, 0.0, 0.0} {
  validate(settings, "navigation.maneuver_planner");
}

ManeuverResult ManeuverPlanner::plan(const Costmap& costmap, const Pose2& T_map_body, bool is_reversing,
                                     const NavigationGoal& goal) const {
  Pose2 T_map_goal = goal.T_map_body;
  if (goal.accepts_any_yaw()) T_map_goal.yaw = arrival_heading(costmap, T_map_body.position(), T_map_goal.position());
  if (costmap.clearance_m(T_map_goal) < 0.0) return {.status = PlanStatus::kGoalBlocked};
  Search search(settings_, costmap, T_body_center_.inverse(), radius_m_, T_map_body * T_body_center_,
                T_map_goal * T_body_center_);
  return search.run(T_map_body * T_body_center_, is_reversing);
}

}  // namespace patrol::plan
