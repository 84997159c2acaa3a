#include "plan/navigation/route_search.h"

#include <utility>

namespace patrol::plan {
namespace {

constexpr Time kAtOnce = std::chrono::milliseconds(50);      // a search at most this long causes no delay
constexpr Time kMinPeriod = std::chrono::milliseconds(500);  // searches without a route are the most expensive
constexpr double kMargin_m = 5.0;                            // of the costmap around start and goal

}  // namespace

RouteSearch::RouteSearch(const NavigatorSettings& settings, std::uint64_t seed)
    : planner_(settings.global_planner, seed),
      planner_cells_per_s_(settings.planner_cells_per_s),
      replan_period_s_(settings.replan_period_s) {}

void RouteSearch::reset() {
  running_.reset();
  begun_at_ = Time::min();
}

bool RouteSearch::is_outdated(Time now) const {
  return has_new_map_ && now - begun_at_ >= from_seconds(replan_period_s_);
}

bool RouteSearch::may_begin(Time now) const {
  return !running_ && (begun_at_ == Time::min() || now - begun_at_ >= kMinPeriod);
}

void RouteSearch::begin(Time now, Costmap& costmap, const Eigen::Vector2d& p_map_start,
                        const Eigen::Vector2d& p_map_goal, bool is_detour) {
  begun_at_ = now;
  has_new_map_ = false;
  costmap.include(p_map_start, kMargin_m);
  costmap.include(p_map_goal, kMargin_m);
  PlanResult route = planner_.plan(costmap.cost(), p_map_start, p_map_goal);
  const Time takes = from_seconds(static_cast<double>(route.num_expanded) / planner_cells_per_s_);
  running_ = Running{.result = {.route = std::move(route), .is_detour = is_detour},
                     .ready = now + (takes < kAtOnce ? Time{} : takes)};
}

std::optional<RouteSearch::Result> RouteSearch::take(Time now) {
  if (!running_ || now < running_->ready) return std::nullopt;
  return std::exchange(running_, std::nullopt)->result;
}

}  // namespace patrol::plan
