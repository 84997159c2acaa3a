#include "app/report/budget_blocks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace patrol::app::budget_blocks_test {
namespace {

using report::Tone;
using ::testing::HasSubstr;

constexpr double kSmallP = 0.01, kLargeP = 0.2;

/// Contribution whose uncorrected 95 % interval does not contain zero.
Contribution contribution(const std::string& name, double center_m, double p_adjusted) {
  return {.name = name,
          .num_pairs = 5,
          .value = score::Interval{.center = center_m, .low = center_m - 1e-4, .high = center_m + 1e-4},
          .p_adjusted = p_adjusted};
}

Budget budget_of(const std::vector<Contribution>& contributions) {
  const score::Interval baseline{.center = 0.05, .low = 0.04, .high = 0.06};
  Budget budget{.metric = "pose.ate_rmse_m",
                .baseline = baseline,
                .ideal = {},
                .contributions = contributions,
                .sum = score::Interval{},
                .interaction = score::Interval{.center = 0.002, .low = 0.001, .high = 0.003}};
  for (const Contribution& entry : contributions) budget.sum->center += entry.value->center;
  const double ideal_m = baseline.center - budget.sum->center - budget.interaction->center;
  budget.ideal = score::Interval{.center = ideal_m, .low = ideal_m - 0.01, .high = ideal_m + 0.01};
  return budget;
}

report::WaterfallChart chart_of(const Budget& budget) {
  return std::get<report::WaterfallChart>(budget_blocks(budget)[0]);
}

TEST(BudgetBlocks, MarkContributionsByTheirCorrectedPValue) {
  const Budget budget = budget_of({contribution("slip", 0.02, kSmallP), contribution("noise", 0.01, kLargeP)});
  const std::vector<report::Block> blocks = budget_blocks(budget);
  const auto& table = std::get<report::TableBlock>(blocks[1]);
  EXPECT_EQ(table.rows[0].back().text, "");
  EXPECT_EQ(table.rows[1].back().text, "not significant");
  const auto& spans = std::get<report::WaterfallChart>(blocks[0]).spans;
  EXPECT_EQ(spans[1].tone, Tone::kBad);
  EXPECT_EQ(spans[2].tone, Tone::kFaint);
  EXPECT_THAT(std::get<report::TextBlock>(blocks[2]).text, HasSubstr("Holm's correction for 2 error sources"));
}

TEST(BudgetBlocks, TheChartLabelsContributionsWithTheSignOfTheTable) {
  const Budget budget = budget_of({contribution("slip", 0.02, kSmallP), contribution("noise", -0.01, kSmallP)});
  const report::WaterfallChart chart = chart_of(budget);
  EXPECT_EQ(chart.spans[1].text, "+2 cm");
  EXPECT_NEAR(chart.spans[1].to, chart.spans[1].from - 2.0, 1e-9);
  EXPECT_EQ(chart.spans[2].text, "-1 cm");
  EXPECT_NEAR(chart.spans[2].to, chart.spans[2].from + 1.0, 1e-9);
  EXPECT_EQ(chart.spans[3].text, "+0.2 cm") << "interaction";
  EXPECT_THAT(chart.caption, HasSubstr("lowers the metric by its contribution"));
}

TEST(BudgetBlocks, AFindingNamesTheFirstSignificantContribution) {
  const Budget budget = budget_of({contribution("noise", 0.02, kLargeP), contribution("slip", 0.01, kSmallP)});
  EXPECT_EQ(budget_finding(budget), "pose.ate_rmse_m: 5 cm: slip contributes 1 cm.");
  EXPECT_THAT(budget_finding(budget_of({contribution("noise", 0.02, kLargeP)})),
              HasSubstr("no error source contributes significantly"));
}

}  // namespace
}  // namespace patrol::app::budget_blocks_test
