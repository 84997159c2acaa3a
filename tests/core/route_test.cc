#include "core/route.h"

#include <gtest/gtest.h>

namespace patrol {
namespace {

TEST(Route, NamesOfStationsAreInTheirOrder) {
  Route route;
  EXPECT_TRUE(route.station_names().empty());
  route.stations.resize(2);
  route.stations[0].name = "valve";
  route.stations[1].name = "home";
  EXPECT_EQ(route.station_names(), (std::vector<std::string>{"valve", "home"}));
}

TEST(SavedGoal, HasItsNumberInItsName) {
  SavedGoal goal;
  goal.number = 2;
  EXPECT_EQ(goal.name(), "goal_2");
}

}  // namespace
}  // namespace patrol
