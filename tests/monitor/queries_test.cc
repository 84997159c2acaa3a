#include "monitor/queries.h"

#include <gtest/gtest.h>

#include "monitor/store.h"
#include "tests/monitor/sample_results.h"
#include "tests/support/temporary_file.h"

namespace patrol::monitor::queries_test {
namespace {

using Json = nlohmann::json;
using namespace patrol::test;

/// A store, and what the page would read of it.
class Queries : public testing::Test {
 protected:
  void add(const std::vector<Result>& results) { store_.add(results, kNoon_ms + 50'000); }
  Database& database() { return store_.database(); }
  Json run() { return Json::parse(run_details(database(), "spot-1", "").value()); }

  TemporaryFolder folder_;
  Store store_{folder_.path()};
};

TEST_F(Queries, ARobotIsWhereItsNewestPoseHasIt) {
  add({status_result(0, "started"), pose_result(1, 1.0), pose_result(2, 2.5), event_result(3, "station_reached", "well_1")});
  const Json robot = Json::parse(robots(database()))["robots"][0];
  EXPECT_EQ(robot["x"], 2.5);
  EXPECT_EQ(robot["at"], "well_1");
  EXPECT_EQ(robot["state"], "started");
  add({status_result(4, "finished")});
  EXPECT_EQ(Json::parse(robots(database()))["robots"][0]["state"], "finished");
}

TEST_F(Queries, ResultsOfAnEarlierRunThatComeLateDoNotMoveTheRobot) {
  add({pose_result(5, 7.0)});
  Result late = result_of("pose", {{"x", 1.0}, {"y", 0.0}, {"yaw", 0.0}}, 1, "run_0");
  add({late});
  const Json robot = Json::parse(robots(database()))["robots"][0];
  EXPECT_EQ(robot["x"], 7.0);
  EXPECT_EQ(robot["run"], "run_1");
}

TEST_F(Queries, ChangesGiveWhatIsNewSinceARevision) {
  add({pose_result(1), event_result(2, "alarm", "well_1")});
  const Json first = Json::parse(changes(database(), 0, kNoon_ms));
  EXPECT_EQ(first["findings"][0]["level"], "alarm");
  EXPECT_EQ(first["open"]["alarm"], 1);
  const std::int64_t since = first["revision"];
  EXPECT_TRUE(Json::parse(changes(database(), since, kNoon_ms))["robots"].empty());
  store_.acknowledge(1, "Li", "", kNoon_ms);
  const Json then = Json::parse(changes(database(), since, kNoon_ms));
  EXPECT_EQ(then["findings"][0]["who"], "Li");
  EXPECT_EQ(then["open"]["alarm"], 0);
}

TEST_F(Queries, ATrackIsThinnedButKeepsItsEnd) {
  std::vector<Result> poses;
  for (int i = 0; i < 2000; ++i) poses.push_back(pose_result(i, 0.01 * i));
  add(poses);
  const Json track = run()["track"];
  EXPECT_LE(track.size(), 601U);
  EXPECT_GE(track.size(), 400U);
  EXPECT_DOUBLE_EQ(track.back()[0], 19.99);
}

TEST_F(Queries, ARunHasItsStationsAndThoseMarkedOnTheWay) {
  add({status_result(0, "started"), event_result(1, "goal_marked", "goal_1")});
  const Json stations = run()["stations"];
  ASSERT_EQ(stations.size(), 2U);
  EXPECT_EQ(stations[1]["name"], "goal_1");
  EXPECT_EQ(stations[1]["position_m"], Json({3.0, 4.0}));
}

TEST_F(Queries, GasOfAStationIsInTheOrderOfTime) {
  add({event_result(2, "gas_measured", "well_1", 8.0), event_result(1, "gas_measured", "well_1", 5.0)});
  const Json gas_points = Json::parse(gas(database(), "street"))["gas"];
  ASSERT_EQ(gas_points.size(), 2U);
  EXPECT_EQ(gas_points[0], Json({"well_1", kNoon_ms + 1000, 5.0}));
}

TEST_F(Queries, ALiningHasItsRingsOverTimeAndItsNewestScan) {
  add({lining_result(1, 4.0), lining_result(20, 12.0, "run_2")});
  const Json json = Json::parse(lining(database(), "street"));
  ASSERT_EQ(json["scans"].size(), 1U);  // the newest of the station
  EXPECT_EQ(json["scans"][0]["run"], "run_2");
  EXPECT_EQ(json["scans"][0]["data"]["cells"].size(), 3U);
  ASSERT_EQ(json["rings"].size(), 4U);  // rings 3 and 4, two scans each
  EXPECT_EQ(json["rings"][0], Json({3, kNoon_ms + 1000, 0.004, 0.0004, 60.0}));
  EXPECT_EQ(json["rings"][1][2], 0.012);
  EXPECT_EQ(json["lines"][0]["change_m"], -0.012);
  EXPECT_EQ(json["lines"][0]["before_m"], -0.004);
}

TEST_F(Queries, ALineOfAnOlderScanThatComesLateDoesNotReplaceTheNewer) {
  add({lining_result(20, 12.0, "run_2"), lining_result(1, 4.0)});
  EXPECT_EQ(Json::parse(lining(database(), "street"))["lines"][0]["change_m"], -0.012);
  EXPECT_EQ(Json::parse(lining(database(), "street"))["scans"][0]["run"], "run_2");
}

TEST_F(Queries, AFindingOfTheLiningIsAnAlarmFromItsLevelOn) {
  add({lining_result(1, 4.0)});
  EXPECT_TRUE(Json::parse(alarms(database(), {}))["findings"].empty());  // a notice
  EXPECT_EQ(run()["findings"].size(), 1U);
  add({lining_result(2, 12.0)});
  const Json alarm = Json::parse(alarms(database(), {}))["findings"][0];
  EXPECT_EQ(alarm["subject"], "ring 3");
  EXPECT_EQ(alarm["x"], 7.0);
}

TEST_F(Queries, HistoryIsPagedFromTheNewestAndFiltered) {
  for (int i = 0; i < 60; ++i) add({event_result(2 * i, "replan", "x"), pose_result(2 * i + 1)});
  const Json first = Json::parse(history(database(), {.robot = "", .kind = ""}));
  ASSERT_EQ(first["results"].size(), 25U);
  EXPECT_TRUE(first["more"].get<bool>());
  const Json third = Json::parse(history(database(), {.robot = "spot-1", .kind = "event", .before = first["results"][24]["seq"].get<std::int64_t>(), .limit = 50}));
  EXPECT_EQ(third["results"].size(), 35U);
  EXPECT_FALSE(third["more"].get<bool>());
  EXPECT_EQ(Json::parse(history(database(), {.robot = "nobody", .kind = ""}))["results"].size(), 0U);
  EXPECT_EQ(Json::parse(history(database(), {.robot = "", .kind = "pose"}))["results"].size(), 25U);
}

}  // namespace
}  // namespace patrol::monitor::queries_test
