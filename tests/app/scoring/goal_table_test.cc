#include "app/scoring/goal_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace patrol::app::goal_table_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

io::Metrics goal(const std::string& name, int arrivals) {
  return {{"name", name},
          {"arrivals", arrivals},
          {"failed", 0},
          {"position_error_m", {{"mean", 0.0213}, {"std", 0.0045}}},
          {"heading_error_deg", {{"mean", 0.31}, {"std", 0.12}}}};
}

TEST(GoalTable, PutsEachGoalBesideItsColumnOfThePaper) {
  const std::string table = goal_table({{"goals", {goal("goal_1", 10), goal("goal_2", 10)}}});
  EXPECT_THAT(table, HasSubstr("goal_1         10     2.13 +- 0.45      0.31 +- 0.12"));
  EXPECT_THAT(table, HasSubstr("17.06 +- 2.77    4.71 +- 1.74"));
  EXPECT_THAT(table, HasSubstr("18.40 +- 2.36    5.20 +- 1.76"));
}

TEST(GoalTable, AFourthGoalHasNoPublishedFigure) {
  const std::string table =
      goal_table({{"goals", {goal("goal_1", 1), goal("goal_2", 1), goal("goal_3", 1), goal("goal_4", 1)}}});
  EXPECT_THAT(table, HasSubstr("goal_4"));
  EXPECT_THAT(table.substr(table.find("goal_4")), Not(HasSubstr("18.")));
}

TEST(GoalTable, SaysHowOftenAGoalWasNotReached) {
  io::Metrics sometimes = goal("goal_1", 7), never = goal("goal_2", 0);
  sometimes["failed"] = 3;
  never["failed"] = 10;
  never["position_error_m"]["mean"] = nullptr;
  const std::string table = goal_table({{"goals", {sometimes, never}}});
  EXPECT_THAT(table, HasSubstr("goal_1          7     2.13"));
  EXPECT_THAT(table, HasSubstr("  goal_1   not reached 3 of 10 times\n"));
  EXPECT_THAT(table, HasSubstr("  goal_2   not reached 10 of 10 times\n"));
}

TEST(GoalTable, WithoutArrivalsThereIsNone) {
  EXPECT_EQ(goal_table({{"mission", 1}}), "");
  io::Metrics missed = goal("goal_1", 0);
  missed["position_error_m"]["mean"] = nullptr;
  EXPECT_EQ(goal_table({{"goals", {missed}}}), "");
}

}  // namespace
}  // namespace patrol::app::goal_table_test
