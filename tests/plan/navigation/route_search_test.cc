#include "plan/navigation/route_search.h"

#include <gtest/gtest.h>

#include "tests/plan/kinematic_drive.h"

namespace patrol::plan::route_search_test {
namespace {

using namespace std::chrono_literals;

Costmap make_costmap() { return Costmap({}, Footprint(make_robot().footprint_m, 1), {}); }

TEST(RouteSearch, GivesItsResultWhenTheRobotsComputerHasIt) {
  Costmap costmap = make_costmap();
  NavigatorSettings settings;
  settings.planner_cells_per_s = 100.0;
  RouteSearch search(settings, 0);
  EXPECT_TRUE(search.may_begin(0s, {}));
  search.begin(0s, costmap, {0.0, 0.0}, {3.0, 0.0}, true);
  EXPECT_TRUE(search.is_running());
  EXPECT_FALSE(search.may_begin(10s, {})) << "one at a time";
  EXPECT_FALSE(search.take(1ms));
  const auto result = search.take(1h);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->route.status, PlanStatus::kFound);
  EXPECT_GT(result->route.num_expanded, 5) << "else it would have been ready at once";
  EXPECT_TRUE(result->is_detour);
  EXPECT_FALSE(search.is_running());
}

TEST(RouteSearch, BeginsAtMostTwiceASecondAndIsOutdatedByAMap) {
  Costmap costmap = make_costmap();
  NavigatorSettings settings;
  settings.replan_period_s = 4.0;
  RouteSearch search(settings, 0);
  search.begin(10s, costmap, {0.0, 0.0}, {1.0, 0.0}, false);
  search.cancel();
  EXPECT_FALSE(search.take(1h));
  EXPECT_FALSE(search.may_begin(10490ms, {}));
  EXPECT_TRUE(search.may_begin(10500ms, {}));
  EXPECT_FALSE(search.is_outdated(20s)) << "no other map";
  search.on_new_map();
  EXPECT_FALSE(search.is_outdated(13s));
  EXPECT_TRUE(search.is_outdated(14s));
  search.reset();
  EXPECT_TRUE(search.may_begin(10s, {}));
}

/// A search without a route from a start; returns its status.
PlanStatus fail(RouteSearch& search, Costmap& costmap, Time now, const Pose2& T_map_start) {
  search.begin(now, costmap, T_map_start, {8.0, 0.0}, false);
  const auto result = search.take(now + 1h);
  return result ? result->route.status : PlanStatus::kFound;
}

/// A keep-out line around the goal at (8, 0).
Costmap make_costmap_with_fence() {
  return Costmap({}, Footprint(make_robot().footprint_m, 1),
                 {{{7.0, -1.0}, {9.0, -1.0}, {9.0, 1.0}, {7.0, 1.0}, {7.0, -1.0}}});
}

TEST(RouteSearch, SlowSearchesWithoutARouteFromTheSameStartAreRepeatedLessOften) {
  Costmap costmap = make_costmap_with_fence();
  NavigatorSettings settings;
  settings.planner_cells_per_s = 1e4;
  RouteSearch search(settings, 0);
  const Pose2 start, beside{0.1, 0.1, 0.1}, moved{0.5, 0.0, 0.0}, turned{0.0, 0.0, 0.3};
  ASSERT_EQ(fail(search, costmap, 0s, start), PlanStatus::kNoRoute);
  EXPECT_FALSE(search.may_begin(990ms, start));
  EXPECT_TRUE(search.may_begin(1s, start));
  ASSERT_EQ(fail(search, costmap, 10s, beside), PlanStatus::kNoRoute);
  EXPECT_FALSE(search.may_begin(11990ms, start));
  EXPECT_TRUE(search.may_begin(12s, start));
  EXPECT_TRUE(search.may_begin(10500ms, moved)) << "from another start there may be a route";
  EXPECT_TRUE(search.may_begin(10500ms, turned));
  for (const Time now : {20s, 30s, 40s}) {
    ASSERT_EQ(fail(search, costmap, now, start), PlanStatus::kNoRoute);
    EXPECT_FALSE(search.may_begin(now + 3990ms, start));
    EXPECT_TRUE(search.may_begin(now + 4s, start)) << "at most 4 s, as the obstacle may leave";
  }
  ASSERT_EQ(fail(search, costmap, 50s, moved), PlanStatus::kNoRoute);
  EXPECT_TRUE(search.may_begin(51s, moved)) << "the first failure from this start";
  search.reset();
  EXPECT_TRUE(search.may_begin(51s, moved)) << "another goal";
  ASSERT_EQ(fail(search, costmap, 60s, moved), PlanStatus::kNoRoute);
  search.begin(70s, costmap, moved, {3.0, 0.0}, false);
  ASSERT_EQ(search.take(1h)->route.status, PlanStatus::kFound);
  EXPECT_TRUE(search.may_begin(70500ms, moved));
}

TEST(RouteSearch, SearchesThatFailAtOnceAreRepeatedTwiceASecond) {
  Costmap costmap = make_costmap_with_fence();
  RouteSearch search({}, 0);
  for (const Time now : {0s, 10s, 20s, 30s}) {
    ASSERT_EQ(fail(search, costmap, now, {}), PlanStatus::kNoRoute);
    EXPECT_TRUE(search.may_begin(now + 500ms, {}));
  }
}

}  // namespace
}  // namespace patrol::plan::route_search_test
