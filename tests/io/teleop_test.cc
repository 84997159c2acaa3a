#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"
#include "io/files/teleop_csv.h"
#include "io/json/teleop_route_json.h"
#include "tests/support/temporary_file.h"

namespace patrol::io::teleop_test {
namespace {

using test::TemporaryFile;
using namespace std::chrono_literals;

template <typename Load>
std::string complaint(const std::string& name, const std::string& text, const Load& load) {
  const TemporaryFile file(name, text);
  try {
    load(file.path());
  } catch (const InputError& error) {
    const std::string what = error.what();
    return what.substr(what.find(name));
  }
  return "";
}

std::string drive_complaint(const std::string& waypoints) {
  return complaint("d.json", R"({"version": 1, "frame": "site", "waypoints": )" + waypoints + "}", load_teleop_route);
}

std::string teleop_error(const std::string& lines) {
  return complaint("r.csv", "time_s,vx_mps,yaw_rate_radps,mark,hand_over\n" + lines, load_teleop);
}

TEST(LoadTeleopRoute, ReadsReversesAndMarks) {
  const TemporaryFile file("d.json", R"({"version": 1, "frame": "site", "waypoints": [
    {"position": [1, 2], "reverse": true}, {"position": [3, 4], "mark_heading_deg": 90}]})");
  const TeleopRoute drive = load_teleop_route(file.path());
  ASSERT_EQ(drive.size(), 2u);
  EXPECT_TRUE(drive[0].is_reverse);
  EXPECT_FALSE(drive[0].is_goal);
  EXPECT_EQ(drive[1].p_m, Eigen::Vector2d(3.0, 4.0));
  EXPECT_TRUE(drive[1].is_goal);
  EXPECT_DOUBLE_EQ(drive[1].heading_rad, std::numbers::pi / 2.0);
}

TEST(LoadTeleopRoute, NamesTheWaypointAndTheKey) {
  EXPECT_EQ(drive_complaint(R"([{"position": [1, 2]}])"), "d.json: waypoints must be at least two");
  EXPECT_EQ(drive_complaint(R"([{"position": [1, 2]}, {"position": [1]}])"),
            "d.json: waypoints[1]: position must be a list of 2 numbers");
  EXPECT_EQ(drive_complaint(R"([{"position": [1, 2], "revers": true}])"),
            "d.json: waypoints[0]: unknown key revers; did you mean reverse?");
  EXPECT_EQ(drive_complaint(R"([{"position": [1, 2], "reverse": 1}])"),
            "d.json: waypoints[0]: reverse must be true or false");
  EXPECT_EQ(drive_complaint(R"([{"position": [1, 2], "mark_heading_deg": 361}])"),
            "d.json: waypoints[0]: mark_heading_deg must be in [-360, 360]");
  EXPECT_EQ(drive_complaint(R"([{"position": [1, 2]}, {"position": [1e300, 2]}])"),
            "d.json: waypoints[1]: position is more than 1000 m from the one before");
}

TEST(LoadTeleop, WhatWasSavedIsReadBack) {
  const TemporaryFile file("r.csv", "");
  save_teleop(file.path(), {{.stamp = 100ms, .vx_mps = 0.5, .yaw_rate_radps = -0.25},
                            {.stamp = 200ms, .save_goal = true},
                            {.stamp = 300ms, .hand_over = true}});
  const std::vector<TeleopCommand> commands = load_teleop(file.path());
  ASSERT_EQ(commands.size(), 3u);
  EXPECT_EQ(commands[0].stamp, 100ms);
  EXPECT_EQ(commands[0].vx_mps, 0.5);
  EXPECT_EQ(commands[0].yaw_rate_radps, -0.25);
  EXPECT_TRUE(commands[1].save_goal);
  EXPECT_TRUE(commands[2].hand_over);
}

TEST(LoadTeleop, NamesTheLine) {
  EXPECT_EQ(complaint("r.csv", "t,v\n", load_teleop),
            "r.csv:1: the first line must be time_s,vx_mps,yaw_rate_radps,mark,hand_over");
  EXPECT_EQ(teleop_error(""), "r.csv: contains no commands");
  EXPECT_EQ(teleop_error("0,1,2,0\n"),
            "r.csv:2: must be 5 numbers with commas between, time_s,vx_mps,yaw_rate_radps,mark,hand_over");
  EXPECT_EQ(teleop_error("0,1,nan,0,0\n"), "r.csv:2: yaw_rate_radps = nan: must be a number");
  EXPECT_EQ(teleop_error("0,fast,0,0,0\n"), "r.csv:2: vx_mps = fast: must be a number");
  EXPECT_EQ(teleop_error("0,1e400,0,0,0\n"), "r.csv:2: vx_mps = 1e400: must be a number");
  EXPECT_EQ(teleop_error("0,1,0,0, 0\n"), "r.csv:2: hand_over =  0: must be a number");
  EXPECT_EQ(teleop_error("0,,0,0,0\n"), "r.csv:2: vx_mps = : must be a number");
  EXPECT_EQ(teleop_error("0,1,0,2,0\n"), "r.csv:2: mark = 2: must be 0 or 1");
  EXPECT_EQ(teleop_error("0,1,0,0,0.5\n"), "r.csv:2: hand_over = 0.5: must be 0 or 1");
  EXPECT_EQ(teleop_error("0,1,0,0,0\n0,1,0,0,0\n"), "r.csv:3: time_s = 0: must be later than in the line before");
}

TEST(LoadTeleop, NumbersBeyondAnyDriveAreRefused) {
  EXPECT_EQ(teleop_error("-1,0,0,0,0\n"), "r.csv:2: time_s = -1: must be in [0, 86400]");
  EXPECT_EQ(teleop_error("1e300,0,0,0,0\n"), "r.csv:2: time_s = 1e+300: must be in [0, 86400]")
      << "no integer of nanoseconds";
  EXPECT_EQ(teleop_error("0,1e300,0,0,0\n"), "r.csv:2: vx_mps = 1e+300: must be in [-100, 100]");
  EXPECT_EQ(teleop_error("0,0,-101,0,0\n"), "r.csv:2: yaw_rate_radps = -101: must be in [-100, 100]");
}

}  // namespace
}  // namespace patrol::io::teleop_test
