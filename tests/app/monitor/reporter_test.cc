#include "app/monitor/reporter.h"

#include <cmath>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/temporary_file.h"

namespace patrol::app::reporter_test {
namespace {

using Json = nlohmann::json;

/// A reporter whose platform is away, and what stands in its outbox.
class Reported : public testing::Test {
 protected:
  void SetUp() override {
    Station station;
    station.name = "well_1";
    station.T_route_body = {4.0, 5.0, 0.0};
    files_.route.stations = {station};
  }
  void on_message(const stack::StackMessage& message) { reporter_.on_message(message); }
  std::vector<Json> results(const std::string& kind) {
    std::vector<Json> list;
    std::istringstream lines(test::read_bytes(folder_ / "outbox.jsonl"));
    for (std::string line; std::getline(lines, line);) {
      if (Json json = Json::parse(line); json["kind"] == kind) list.push_back(std::move(json));
    }
    return list;
  }

  test::TemporaryFolder folder_;
  ScenarioFiles files_;
  Reporter reporter_{folder_.path(),
                     {.robot = "spot-1", .run = "run_1", .world = "street", .scenario = "short"},
                     {.url = {.host = "127.0.0.1", .port = "1"}, .token = "0123456789abcdef"},
                     {.drain_timeout_s = 0.01}};
};

OccupancyGrid map_with(std::int8_t value) {
  return OccupancyGrid({.resolution_m = 0.1, .width = 2, .height = 2, .origin_m = {0.0, 0.0}}, value);
}

TEST_F(Reported, ARunBeginsWithItsStationsAndEndsWithWhatBecameOfIt) {
  reporter_.begin(files_);
  reporter_.finish("failed", "the robot\nfell");
  const auto status = results("status");
  ASSERT_EQ(status.size(), 2U);
  EXPECT_EQ(status[0]["data"]["state"], "started");
  EXPECT_EQ(status[0]["data"]["stations"][0]["position_m"], Json({4.0, 5.0}));
  EXPECT_EQ(status[0]["id"], "spot-1/run_1/0");
  EXPECT_EQ(status[1]["data"]["message"], "the robot\\nfell");
  EXPECT_EQ(reporter_.num_pending(), 2U);
}

TEST_F(Reported, PosesAreThinnedToOneASecond) {
  reporter_.begin(files_);
  for (int i = 0; i <= 300; ++i) {
    PoseEstimate pose;
    pose.stamp = std::chrono::milliseconds(20 * i);
    on_message(stack::StackMessage(pose));
  }
  EXPECT_EQ(results("pose").size(), 7U);  // at 0, 1, ... 6 s
}

TEST_F(Reported, AMapIsSentWhenItChangedAtMostEveryTenSecondsAndAtTheEnd) {
  reporter_.begin(files_);
  for (int s = 0; s <= 30; ++s)
    on_message(stack::StackMessage(MapUpdate{.stamp = std::chrono::seconds(s),
                                             .map = map_with(s < 15   ? kUnknown
                                                             : s < 27 ? kFree
                                                                      : kOccupied)}));
  std::vector<long> times;
  for (const Json& map : results("map")) times.push_back(std::lround(map["time_s"].get<double>()));
  EXPECT_EQ(times, (std::vector{0L, 15L, 27L}));
  on_message(stack::StackMessage(MapUpdate{.stamp = std::chrono::seconds(31), .map = map_with(kUnknown)}));
  reporter_.finish("finished", "");
  EXPECT_EQ(std::lround(results("map").back()["time_s"].get<double>()), 31);
  EXPECT_EQ(results("map").size(), 4U);
}

TEST_F(Reported, AnEventKeepsItsWordsFigureAndPlace) {
  reporter_.begin(files_);
  Event event;
  event.stamp = std::chrono::seconds(2);
  event.kind = EventKind::kGasAlarm;
  event.subject = "well_1";
  event.text = "Leak.";
  event.value = 640.0;
  event.p_map_target = {3.0, 4.0};
  on_message(stack::StackMessage(event));
  const Json data = results("event").at(0)["data"];
  EXPECT_EQ(data["value"], 640.0);
  EXPECT_EQ(data["position_m"], Json({3.0, 4.0}));
}

TEST_F(Reported, TheGroundTruthIsNotTold) {
  reporter_.begin(files_);
  const auto before = test::read_bytes(folder_ / "outbox.jsonl");
  GroundTruth truth;
  reporter_.on_ground_truth(truth);
  EXPECT_EQ(test::read_bytes(folder_ / "outbox.jsonl"), before);
}

TEST_F(Reported, WhatNeverBeganLeavesNothing) {
  reporter_.finish("failed", "x");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "outbox.jsonl"));
}

TEST(RunName, NeverComesTwice) { EXPECT_NE(new_run_name("short", 1), new_run_name("short", 1)); }

}  // namespace
}  // namespace patrol::app::reporter_test
