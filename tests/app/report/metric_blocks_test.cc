#include "app/report/metric_blocks.h"

#include <gtest/gtest.h>

namespace patrol::app::metric_blocks_test {
namespace {

using report::TableBlock;

TEST(KeyMetrics, AreInTheUnitOfTheirSizeAndOnlyWhatWasMeasured) {
  const report::KeyMetrics metrics =
      key_metrics(io::Metrics::parse(R"({"pose": {"ate_rmse_m": 0.0026, "ate_max_m": 0.023, "heading_rmse_deg": null},
      "stations": [{"reached": true}, {"reached": false}], "goals": []})"));
  ASSERT_EQ(metrics.metrics.size(), 2u);
  EXPECT_EQ(metrics.metrics[0].value + metrics.metrics[0].unit, "2.6mm");
  EXPECT_EQ(metrics.metrics[0].note, "at most 2.3 cm");
  EXPECT_EQ(metrics.metrics[1].value, "1 of 2");
}

TEST(AllMetrics, AreGroupedAndSayWhatWasExpected) {
  const report::CollapsibleTables all = all_metrics(
      io::Metrics::parse(R"({"mission": {"completed": true}, "pose": {"aligned": {"rmse_m": 0.5}, "poses": 3}})"),
      {{.metric = "pose.aligned.rmse_m", .wanted = "<= 0.1", .got = "0.5", .is_measured = true, .is_met = false}});
  EXPECT_EQ(all.summary, "All 3 metrics");
  ASSERT_EQ(all.tables.size(), 2u);
  EXPECT_EQ(all.tables[1].caption, "pose");
  EXPECT_EQ(all.tables[1].rows[0][0].text, "aligned.rmse_m");
  EXPECT_EQ(all.tables[1].rows[0][2].text, "<= 0.1 MISSED");
  EXPECT_EQ(all.tables[1].rows[1][2].text, "");
}

io::Metrics goal(const std::string& name, const std::vector<double>& each_m, int failed) {
  const io::Metrics spread = {{"mean", 0.02}, {"std", 0.001}, {"max", 0.03}, {"each", each_m}};
  return {{"name", name},
          {"arrivals", each_m.size()},
          {"failed", failed},
          {"position_error_m", spread},
          {"heading_error_deg", spread}};
}

TEST(GoalBlocks, AreATableInCentimetresAndABoxOfEveryArrival) {
  const io::Metrics metrics = {{"goals", {goal("goal_1", {0.01, 0.02, 0.05}, 0), goal("goal_2", {0.03}, 1)}}};
  const std::vector<report::Block> blocks = goal_blocks(metrics);
  ASSERT_EQ(blocks.size(), 4u);  // and what the boxes mean
  const auto& table = std::get<TableBlock>(blocks[0]);
  EXPECT_EQ(table.rows[0][3].text, "2.00");
  EXPECT_EQ(table.rows[1][2].tone, report::Tone::kBad);
  const auto& boxes = std::get<report::BoxPlot>(blocks[1]);
  ASSERT_EQ(boxes.boxes.size(), 2u);
  EXPECT_DOUBLE_EQ(boxes.boxes[0].median, 2.0);
  EXPECT_DOUBLE_EQ(boxes.boxes[0].upper_quartile, 3.5);  // halfway from the second to the third
  EXPECT_EQ(boxes.boxes[0].values.size(), 3u);
}

TEST(GoalBlocks, OfASingleNavigationHaveNoBoxes) {
  EXPECT_EQ(goal_blocks({{"goals", {goal("goal_1", {0.01}, 0)}}}).size(), 1u);
  EXPECT_TRUE(goal_blocks(io::Metrics::object()).empty());
}

TEST(InspectionBlocks, TellLeaksFromFalseAlarms) {
  const io::Metrics metrics = io::Metrics::parse(R"({"inspection": {"leaks": 1, "findings": [
      {"station": "a", "column_ppm_m": 5776.9, "x_m": 1, "y_m": 2, "leak": "a", "position_error_m": 0.0656},
      {"station": "b", "column_ppm_m": 10, "x_m": 1, "y_m": 2, "leak": null, "position_error_m": null}]}})");
  const TableBlock table = std::get<TableBlock>(inspection_blocks(metrics).at(0));
  EXPECT_EQ(table.rows[0][5].text, "6.6");
  EXPECT_EQ(table.rows[1][4].text, "false alarm");
  EXPECT_TRUE(inspection_blocks(io::Metrics::parse(R"({"inspection": {"leaks": 0, "findings": []}})")).empty());
}

TEST(PerformanceBlocks, AreInOrderOfTimeWithTheRestLast) {
  const io::Metrics metrics =
      io::Metrics::parse(R"({"performance": {"wall_s": 10, "parts_s": {"lidar": 2, "physics": 5}}})");
  const auto bars = std::get<report::BarBlock>(performance_blocks(metrics).at(0)).bars;
  ASSERT_EQ(bars.size(), 3u);
  EXPECT_EQ(bars[0].label, "physics");
  EXPECT_EQ(bars[2].label, "other");
  EXPECT_DOUBLE_EQ(bars[2].value, 3.0);
}

}  // namespace
}  // namespace patrol::app::metric_blocks_test
