#include "plan/navigation/route_search.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "core/geometry/angles.h"

namespace patrol::plan {
namespace {

constexpr Time kAtOnce = std::chrono::milliseconds(50);      // a search at most this long causes no delay
constexpr Time kMinPeriod = std::chrono::milliseconds(500);  // searches without a route are the most expensive
constexpr int kMaxDoublings = 3;                             // of the period, by failures: up to 4 s
constexpr double kSameStart_m = 0.25;                        // starts closer than this, and
constexpr double kSameStart_rad = 10.0 * kDegree;            // with less difference of the heading, are the same
constexpr double kMargin_m = 5.0;                            // of the costmap around start and goal
constexpr std::int64_t kCellsPerState = 100;                 // time of a state of a maneuver search, in cells

bool is_same_start(const Pose2& a, const Pose2& b) {
  return (a.position() - b.position()).norm() < kSameStart_m && std::abs(wrap_angle(a.yaw - b.yaw)) < kSameStart_rad;
}

}  // namespace

RouteSearch::RouteSearch(const NavigatorSettings& settings, std::uint64_t seed,
                         std::optional<ManeuverPlanner> maneuvers)
    : planner_(settings.global_planner, seed),
      maneuvers_(std::move(maneuvers)),
      planner_cells_per_s_(settings.planner_cells_per_s),
      replan_period_s_(settings.replan_period_s) {}

void RouteSearch::reset() {
  running_.reset();
  begun_at_ = Time::min();
  num_failed_ = 0;
}

bool RouteSearch::is_outdated(Time now) const {
  return has_new_map_ && now - begun_at_ >= from_seconds(replan_period_s_);
}

bool RouteSearch::may_begin(Time now, const Pose2& T_map_start) const {
  if (running_) return false;
  if (begun_at_ == Time::min()) return true;
  const int doublings = is_same_start(T_map_start, T_map_start_) ? std::min(num_failed_, kMaxDoublings) : 0;
  return now - begun_at_ >= kMinPeriod * (1 << doublings);
}

void RouteSearch::begin(Time now, Costmap& costmap, const Pose2& T_map_start, const NavigationGoal& goal,
                        bool is_detour, bool is_reversing) {
  if (!is_same_start(T_map_start, T_map_start_)) num_failed_ = 0;
  begun_at_ = now;
  T_map_start_ = T_map_start;
  has_new_map_ = false;
  costmap.include(T_map_start.position(), kMargin_m);
  costmap.include(goal.T_map_body.position(), kMargin_m);
  PlanResult route = plan(costmap, T_map_start, goal, is_reversing);
  const Time takes = from_seconds(static_cast<double>(route.num_expanded) / planner_cells_per_s_);
  running_ = Running{.result = {.route = std::move(route), .is_detour = is_detour},
                     .ready = now + (takes < kAtOnce ? Time{} : takes)};
}

PlanResult RouteSearch::plan(Costmap& costmap, const Pose2& T_map_start, const NavigationGoal& goal,
                             bool is_reversing) {
  if (!maneuvers_) return planner_.plan(costmap.cost(), T_map_start.position(), goal.T_map_body.position());
  ManeuverResult found = maneuvers_->plan(costmap, T_map_start, is_reversing, goal);
  PlanResult route{.status = found.status,
                   .cost_m = found.cost_m,
                   .num_expanded = kCellsPerState * found.num_expanded + found.num_cells};
  if (found.status != PlanStatus::kFound) return route;
  const Pose2 T_center_body = maneuvers_->T_body_center().inverse();
  for (const ManeuverPose& pose : found.maneuver)
    route.points_m.push_back((pose.T_map_center * T_center_body).position());
  route.length_m = found.maneuver.back().along_m;
  route.maneuver = std::move(found.maneuver);
  return route;
}

std::optional<RouteSearch::Result> RouteSearch::take(Time now) {
  if (!running_ || now < running_->ready) return std::nullopt;
  const bool has_failed_slowly = running_->result.route.status != PlanStatus::kFound && running_->ready > begun_at_;
  num_failed_ = has_failed_slowly ? num_failed_ + 1 : 0;
  return std::exchange(running_, std::nullopt)->result;
}

}  // namespace patrol::plan
