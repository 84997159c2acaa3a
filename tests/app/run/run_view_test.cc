#include "app/run/run_view.h"

#include <numbers>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/files/one_line.h"

namespace patrol::app::watch_frame_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr int kColumns = 40, kRows = 20;

/// An empty field of 6 x 6 m about the origin, the robot in the middle.
RunView in_a_field() {
  RunView run;
  run.name = "field";
  run.map = OccupancyGrid({.resolution_m = 0.05, .width = 120, .height = 120, .origin_m = {-3.0, -3.0}}, kFree);
  run.estimate = PoseEstimate{
      .stamp = {}, .T_map_body = {0.0, 0.0, 0.0}, .covariance = Eigen::Vector3d(0.0004, 0.0005, 0.0).asDiagonal()};
  return run;
}

std::size_t lines_of(const std::string& frame) {
  return static_cast<std::size_t>(std::count(frame.begin(), frame.end(), '\n')) + 1;
}

TEST(WatchFrame, FillsTheTerminalExactly) {
  RunView run = in_a_field();
  EXPECT_EQ(lines_of(render_run_view(run, kColumns, kRows)), static_cast<std::size_t>(kRows));
  for (int i = 0; i < 30; ++i)
    run.events.push_back(
        {.stamp = {}, .kind = EventKind::kGasAlarm, .subject = "", .text = std::string(200, 'x'), .T_map_body = {}});
  EXPECT_EQ(lines_of(render_run_view(run, kColumns, kRows)), static_cast<std::size_t>(kRows));
}

TEST(WatchFrame, TheRobotIsAnArrowAlongItsHeading) {
  RunView run = in_a_field();
  EXPECT_THAT(render_run_view(run, kColumns, kRows), HasSubstr("→\033"));
  run.estimate->T_map_body.yaw = std::numbers::pi / 2.0;
  EXPECT_THAT(render_run_view(run, kColumns, kRows), HasSubstr("↑"));
  run.estimate->T_map_body.yaw = -3.0 * std::numbers::pi / 4.0;
  EXPECT_THAT(render_run_view(run, kColumns, kRows), HasSubstr("↙"));
}

// One dot is 15 cm; the robot's own is the upper left one of the character right of and below the middle.
TEST(WatchFrame, AWallAheadIsItsColumnOfDots) {
  RunView run = in_a_field();
  for (int row = 0; row < 120; ++row) run.map.at({75, row}) = kOccupied;  // x = 0.775 m: the sixth dot from the middle
  EXPECT_THAT(render_run_view(run, kColumns, kRows), HasSubstr("⢸"));
  EXPECT_THAT(render_run_view(in_a_field(), kColumns, kRows), Not(HasSubstr("⢸")));
}

TEST(WatchFrame, TellsTheErrorOfTheEstimateBesideItsOwnDeviation) {
  RunView run = in_a_field();
  run.truth = Pose2{0.3, 0.4, 0.0};
  const std::string frame = render_run_view(run, kColumns, kRows);
  EXPECT_THAT(frame, HasSubstr("error 0.500 m"));
  EXPECT_THAT(frame, HasSubstr("estimated 2σ 0.060 m"));
}

TEST(WatchFrame, TheNewestEventsStay) {
  RunView run = in_a_field();
  for (const char* text : {"first", "second", "third", "fourth", "fifth"}) {
    run.events.push_back({.stamp = {}, .subject = "", .text = text, .T_map_body = {}});
  }
  EXPECT_THAT(render_run_view(run, kColumns, kRows), HasSubstr("fifth"));
  EXPECT_THAT(render_run_view(run, kColumns, kRows), Not(HasSubstr("first")));
}

TEST(WatchFrame, TheTextOfAnEventIsCutBetweenTwoCharacters) {
  std::string umlauts;
  for (int i = 0; i < 100; ++i) umlauts += "ä";
  RunView run = in_a_field();
  run.events = {{.stamp = {}, .kind = EventKind::kGasAlarm, .subject = "", .text = umlauts, .T_map_body = {}}};
  for (const int columns : {kColumns, kColumns + 1}) {
    const std::string frame = render_run_view(run, columns, kRows);
    EXPECT_THAT(frame, HasSubstr("ää"));
    EXPECT_TRUE(io::is_utf8(frame));
  }
}

TEST(WatchFrame, ATinyTerminalIsNoReasonToFail) { EXPECT_FALSE(render_run_view(in_a_field(), 1, 1).empty()); }

}  // namespace
}  // namespace patrol::app::watch_frame_test
