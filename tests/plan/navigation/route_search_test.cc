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
  EXPECT_TRUE(search.may_begin(0s));
  search.begin(0s, costmap, {0.0, 0.0}, {3.0, 0.0}, true);
  EXPECT_TRUE(search.is_running());
  EXPECT_FALSE(search.may_begin(10s)) << "one at a time";
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
  EXPECT_FALSE(search.may_begin(10490ms));
  EXPECT_TRUE(search.may_begin(10500ms));
  EXPECT_FALSE(search.is_outdated(20s)) << "no other map";
  search.on_new_map();
  EXPECT_FALSE(search.is_outdated(13s));
  EXPECT_TRUE(search.is_outdated(14s));
  search.reset();
  EXPECT_TRUE(search.may_begin(10s));
}

}  // namespace
}  // namespace patrol::plan::route_search_test
