#include "app/scoring/score_table.h"

#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace patrol::app::score_table_test {
namespace {

/// The words of the line that begins with a metric; empty if there is none.
std::vector<std::string> line_of(const std::string& table, const std::string& metric) {
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::vector<std::string> found;
    for (std::string word; words >> word;) found.push_back(word);
    if (!found.empty() && found.front() == metric) return found;
  }
  return {};
}

using Words = std::vector<std::string>;

io::Metrics make_metrics() {
  return io::Metrics::parse(R"({
    "mission": {"completed": true, "collisions": 0},
    "pose": {"ate_rmse_m": 0.0712345},
    "stations": [{"name": "box", "map_error_m": 0.04}, {"name": "well", "map_error_m": 0.09}]
  })");
}

TEST(ScoreTable, HasOneLineForEachFigure) {
  const std::string table = score_table(make_metrics(), {});
  EXPECT_EQ(line_of(table, "mission.completed"), (Words{"mission.completed", "yes"}));
  EXPECT_EQ(line_of(table, "mission.collisions"), (Words{"mission.collisions", "0"}));
  EXPECT_EQ(line_of(table, "pose.ate_rmse_m"), (Words{"pose.ate_rmse_m", "0.07123"}));
  EXPECT_EQ(line_of(table, "stations.well.map_error_m"), (Words{"stations.well.map_error_m", "0.09"}));
}

TEST(ScoreTable, SaysOfEachExpectationWhetherItWasMet) {
  const std::vector<CheckedExpectation> checks = {
      {.metric = "pose.ate_rmse_m", .wanted = "<= 0.08", .got = "0.07123", .is_measured = true, .is_met = true},
      {.metric = "mission.collisions", .wanted = "= 1", .got = "0", .is_measured = true, .is_met = false}};
  const std::string table = score_table(make_metrics(), checks);
  EXPECT_EQ(line_of(table, "pose.ate_rmse_m"), (Words{"pose.ate_rmse_m", "0.07123", "<=", "0.08", "met"}));
  EXPECT_EQ(line_of(table, "mission.collisions"), (Words{"mission.collisions", "0", "=", "1", "MISSED"}));
}

TEST(ScoreTable, WhatWasExpectedAndNotMeasuredStandsThereToo) {
  const std::string table = score_table(
      make_metrics(),
      {{.metric = "map.coverage", .wanted = ">= 0.9", .got = "not measured", .is_measured = false, .is_met = false}});
  EXPECT_EQ(line_of(table, "map.coverage"), (Words{"map.coverage", "not", "measured", ">=", "0.9", "MISSED"}));
}

TEST(ScoreTable, GroupsStandApart) {
  const std::string table = score_table(make_metrics(), {});
  EXPECT_THAT(table, ::testing::ContainsRegex("mission.collisions[^\n]*\n\n  pose.ate_rmse_m"));
  EXPECT_THAT(table, ::testing::ContainsRegex("mission.completed[^\n]*\n  mission.collisions"));
}

TEST(ScoreTable, OfNothingIsEmpty) { EXPECT_EQ(score_table(io::Metrics::object(), {}), ""); }

TEST(ScoreTable, LeavesOutListsOfPlainNumbers) {
  const std::string table =
      score_table(io::Metrics::parse(R"({"docking": {"position_error_m": {"mean": 0.02, "each": [0.01, 0.03]}}})"), {});
  EXPECT_EQ(line_of(table, "docking.position_error_m.mean"), (Words{"docking.position_error_m.mean", "0.02"}));
  EXPECT_EQ(table.find("each"), std::string::npos);
}

}  // namespace
}  // namespace patrol::app::score_table_test
