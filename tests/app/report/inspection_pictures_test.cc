#include "app/report/inspection_pictures.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

namespace patrol::app::inspection_pictures_test {
namespace {

using namespace std::chrono_literals;

RunContents run_with_lining() {
  RunContents run;
  LiningResult result;
  result.station = "goal_1";
  result.is_registered = true;
  result.cells = {{.ring = 20, .clock_deg = 0.0, .inward_m = 0.0042},
                  {.ring = 22, .clock_deg = 270.0, .inward_m = -0.001}};
  result.findings = {{.ring = 20, .clock_deg = 0.0, .inward_m = 0.0042, .std_m = 0.0003}};
  run.record.linings = {result};
  run.metrics = io::Metrics::parse(R"({"inspection": {"lining": {"stations": 1, "rings": [
      {"station": "goal_1", "ring": 20, "true_peak_mm": 4.5, "is_found": true},
      {"station": "goal_1", "ring": 21, "true_peak_mm": -3.0, "is_found": false},
      {"station": "goal_2", "ring": 22, "true_peak_mm": 3.0, "is_found": true}]}}})");
  return run;
}

TEST(LiningPictures, AreUnrolledFromTheInvertOverTheLeftWallAndTheCrown) {
  const std::vector<report::Block> blocks = lining_pictures(run_with_lining());
  ASSERT_EQ(blocks.size(), 1u);
  const auto& map = std::get<report::HeatMap>(blocks[0]);
  EXPECT_EQ(map.columns, (std::vector<std::string>{"20", "21", "22"}));
  ASSERT_EQ(map.cells.size(), 2u);
  ASSERT_EQ(map.rows.size(), 10u);  // from the left wall to the crown
  EXPECT_EQ(map.rows.front(), "left wall");
  EXPECT_EQ(map.rows.back(), "crown");
  EXPECT_EQ(map.cells[0].row, 9);
  EXPECT_EQ(map.cells[1].row, 0);
  EXPECT_DOUBLE_EQ(map.cells[0].value, 4.2);
  EXPECT_DOUBLE_EQ(map.max, 5.0);
  ASSERT_EQ(map.marks.size(), 1u);
  EXPECT_EQ(map.marks[0].text, "+4.2 ± 0.6 mm");
}

TEST(LiningPictures, OfSectorsOfFiveDegreesHaveARowForEach) {
  RunContents run = run_with_lining();
  run.scenario.stack.inspection.lining.sector_deg = 5.0;
  run.record.linings[0].cells = {
      {.ring = 20, .clock_deg = 355.0}, {.ring = 20, .clock_deg = 0.0}, {.ring = 20, .clock_deg = 5.0}};
  const std::vector<report::Block> blocks = lining_pictures(run);
  const auto& map = std::get<report::HeatMap>(blocks.at(0));
  EXPECT_EQ(map.rows, (std::vector<std::string>{"", "crown", ""}));
  EXPECT_EQ(map.cells[2].row, 2);
}

TEST(LiningPictures, ShowTheTruthOfTheirOwnRingsAndMissedOnesInRed) {
  const std::vector<report::Block> blocks = lining_pictures(run_with_lining());
  const auto& notes = std::get<report::HeatMap>(blocks.at(0)).notes;
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_EQ(notes[0].tone, report::Tone::kGood);
  EXPECT_EQ(notes[1].text, "-3.0");
  EXPECT_EQ(notes[1].tone, report::Tone::kBad);
}

TEST(LiningPictures, OfAScanThatWasNotRegisteredThereIsNone) {
  RunContents run = run_with_lining();
  run.record.linings[0].is_registered = false;
  EXPECT_TRUE(lining_pictures(run).empty());
}

// The robot is at (10, 0) in map, faces +y, at a height of 0.3 m; the map is at (100, 0) in world.
TEST(WaterPictures, AreInTheFrameOfTheRobotAndShowTheTruthBesideTheResult) {
  RunContents run;
  run.T_world_map = {100.0, 0.0, 0.0};
  run.record.T_world_body = {{0ns, to_pose3({110.0, 0.0, 0.0}, 0.3)}, {10s, to_pose3({110.0, 0.0, 0.0}, 0.3)}};
  WaterResult result;
  result.stamp = 5s;
  result.T_map_body = {10.0, 0.0, M_PI / 2.0};
  result.is_found = true;
  result.p_map = {8.0, 20.0, 1.0};
  result.covariance_m2 = Eigen::Vector3d(1.0, 4.0, 1.0).asDiagonal();
  result.radius_m = 3.0;
  run.record.waters = {result};
  run.scenario.water_bodies = {{.x_m = 108.0, .y_m = 21.0, .z_m = 1.3, .radius_m = 3.0}};
  const std::vector<report::Block> blocks = water_pictures(run);
  ASSERT_EQ(blocks.size(), 2u);
  const auto& above = std::get<report::PlanView>(blocks[0]);
  const auto center = [](const report::MapPath& path) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (std::size_t i = 0; i + 1 < path.pieces_m.at(0).size(); ++i) sum += path.pieces_m[0][i];
    return Eigen::Vector2d(sum / static_cast<double>(path.pieces_m[0].size() - 1));
  };
  EXPECT_TRUE(center(above.paths.at(0)).isApprox(Eigen::Vector2d(21.0, 2.0), 1e-9));  // truth
  EXPECT_TRUE(center(above.paths.at(1)).isApprox(Eigen::Vector2d(20.0, 2.0), 1e-9));  // result
  double half_length_m = 0.0;
  for (const Eigen::Vector2d& p_m : above.paths.at(2).pieces_m.at(0))
    half_length_m = std::max(half_length_m, p_m.x() - 20.0);
  EXPECT_NEAR(half_length_m, 2.0 * std::sqrt(7.815), 0.01);  // the larger axis is ahead
  const auto& side = std::get<report::PlanView>(blocks[1]);
  EXPECT_TRUE(center(side.paths.at(0)).isApprox(Eigen::Vector2d(21.0, 1.0), 1e-9));
  EXPECT_LE(side.low_m.x(), 0.0);  // the robot is in view
  run.record.waters[0].is_found = false;
  EXPECT_TRUE(water_pictures(run).empty());
}

}  // namespace
}  // namespace patrol::app::inspection_pictures_test
