#include "app/campaign/sweep/budget.h"

#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/campaign/sweep/error_sources.h"
#include "app/scenario/scenario.h"

namespace patrol::app::budget_test {
namespace {

using ::testing::HasSubstr;

constexpr const char* kMetric = "pose.ate_rmse_m";

/// "baseline", without noise, without slip, "all ideal"; for each seed one figure a variant.
SweepManifest manifest_for(const std::vector<std::vector<double>>& values) {
  SweepManifest manifest{.scenario = "s.yaml",
                         .overrides = {},
                         .paths = {},
                         .variants = {},
                         .seeds = {},
                         .metrics = {kMetric},
                         .stop = {},
                         .runs = {}};
  for (const char* name : {"baseline", "noise", "slip", "all ideal"})
    manifest.variants.push_back({.name = name, .overrides = {}});
  for (std::uint64_t seed = 1; seed <= values.size(); ++seed) {
    manifest.seeds.push_back(seed);
    for (std::size_t variant = 0; variant < 4; ++variant)
      manifest.runs.push_back({.variant = variant, .seed = seed, .overrides = {}, .hash = ""});
  }
  return manifest;
}

SweepRows rows_with(const std::vector<std::vector<double>>& values) {
  SweepRows rows;
  for (const std::vector<double>& of_seed : values) {
    for (const double value : of_seed) {
      rows.emplace_back(RunVerdict{.end = RunStatus::kDone,
                                   .message = "",
                                   .metrics = {{"pose", {{"ate_rmse_m", value}}}},
                                   .checks = {},
                                   .events = {}});
    }
  }
  return rows;
}

Budget budget_of(const std::vector<std::vector<double>>& values) {
  return make_budget(manifest_for(values), rows_with(values), kMetric);
}

TEST(Budget, TheLargestShareComesFirstAndSumAndInteractionAddUp) {
  // Seed 1: 10 less 9 is 1 for noise, 10 less 4 is 6 for slip, 10 less 2 is 8 in all: 1 more than the sum.
  // Seed 2: the same with 1, 7, 9.
  const Budget budget = budget_of({{10.0, 9.0, 4.0, 2.0}, {12.0, 11.0, 5.0, 3.0}});
  ASSERT_EQ(budget.contributions.size(), 2u);
  EXPECT_EQ(budget.contributions[0].name, "slip");
  EXPECT_DOUBLE_EQ(budget.contributions[0].value->center, 6.5);
  EXPECT_DOUBLE_EQ(budget.contributions[1].value->center, 1.0);
  EXPECT_DOUBLE_EQ(budget.sum->center, 7.5);
  EXPECT_DOUBLE_EQ(budget.interaction->center, 1.0);
  EXPECT_NEAR(budget.baseline->center - budget.sum->center - budget.interaction->center, budget.ideal->center, 1e-12);
}

TEST(Budget, SharesArePairedBySeed) {
  // The figures differ by metres from seed to seed, the contribution by nothing.
  const Budget budget = budget_of({{1.0, 0.9, 1.0, 0.9}, {5.0, 4.9, 5.0, 4.9}, {9.0, 8.9, 9.0, 8.9}});
  EXPECT_EQ(budget.contributions[0].name, "noise");
  EXPECT_NEAR(budget.contributions[0].value->high - budget.contributions[0].value->low, 0.0, 1e-12);
  EXPECT_TRUE(budget.contributions[1].value->contains(0.0));
}

TEST(Budget, ARunWithoutTheFigureLeavesItsPairOut) {
  const std::vector<std::vector<double>> values = {{1.0, 0.9, 1.0, 0.9}, {5.0, 4.9, 5.0, 4.9}, {9.0, 8.9, 9.0, 8.9}};
  SweepRows rows = rows_with(values);
  rows[1]->metrics = {};
  const Budget budget = make_budget(manifest_for(values), rows, kMetric);
  EXPECT_EQ(budget.contributions[0].num_pairs + budget.contributions[1].num_pairs, 5u);
}

TEST(Budget, TheTextGoesFromAsItIsToAllIdealAndMarksWhatIsNotClear) {
  const std::string text = budget_text(budget_of({{10.0, 9.0, 4.0, 2.0}, {12.0, 12.5, 5.0, 3.0}}));
  EXPECT_LT(text.find("baseline"), text.find("slip"));
  EXPECT_LT(text.find("slip"), text.find("all ideal"));
  EXPECT_THAT(text, HasSubstr("not significant"));
  EXPECT_THAT(text, HasSubstr("sum of the contributions"));
}

// Differences 1, 2, 1.5: t = 5.196, p = 0.035. Of two sources, Holm's correction doubles the smallest p-value.
TEST(Budget, AShareWithAPValueOfThreePercentIsNotSignificantAmongTwoSources) {
  const Budget budget = budget_of({{10.0, 9.0, 9.9, 8.0}, {10.0, 8.0, 10.1, 8.0}, {10.0, 8.5, 10.0, 8.0}});
  EXPECT_FALSE(budget.contributions[0].value->contains(0.0));
  EXPECT_NEAR(*budget.contributions[0].p_adjusted, 2.0 * 0.0351, 1e-4);
  EXPECT_FALSE(budget.contributions[0].is_significant());
}

TEST(Budget, OfAMetricThatIsZeroInEveryRunHasBars) {
  const std::string text = budget_text(budget_of({{0.0, 0.0, 0.0, 0.0}, {0.0, 0.0, 0.0, 0.0}}));
  EXPECT_THAT(text, HasSubstr("+0 [+0, +0]"));
}

TEST(Budget, TheTextHasColumnsForNamesOfAnyLength) {
  const std::vector<std::vector<double>> values = {{10.0, 9.0, 4.0, 2.0}, {12.0, 11.0, 5.0, 3.0}};
  SweepManifest manifest = manifest_for(values);
  manifest.variants[1].name = "as built: mounting pose of the lidar and of the IMU";
  const std::string text = budget_text(make_budget(manifest, rows_with(values), kMetric));
  std::set<std::size_t> columns;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.find(']') != std::string::npos) columns.insert(line.find(']'));
  }
  EXPECT_EQ(columns.size(), 1u) << text;
}

TEST(Budget, SmallContributionsHaveFourSignificantDigits) {
  const std::string text = budget_text(budget_of({{10e-6, 9e-6, 4e-6, 2e-6}, {12e-6, 11e-6, 5e-6, 3e-6}}));
  EXPECT_THAT(text, HasSubstr("+6.5e-06 ["));
}

TEST(Budget, WithoutFiguresItSaysSo) {
  const std::vector<std::vector<double>> values = {{1.0, 0.9, 1.0, 0.9}};
  EXPECT_THAT(budget_text(budget_of(values)), HasSubstr("too few runs"));
}

TEST(Imperfections, EachHasANameOfItsOwnAndSettingsThatThereAre) {
  std::set<std::string> names;
  const std::filesystem::path street = PATROL_SOURCE_DIR "/worlds/street/scenarios/short.yaml";
  for (const ScenarioErrorSource& source : scenario_error_sources()) {
    EXPECT_TRUE(names.insert(source.name).second) << source.name;
    EXPECT_NO_THROW(load_scenario(street, source.overrides)) << source.name;
  }
}

}  // namespace
}  // namespace patrol::app::budget_test
