#include "monitor/queries.h"

#include <map>
#include <set>

#include <gtest/gtest.h>

#include "core/error.h"
#include "monitor/store.h"
#include "monitor/views.h"
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
  add({status_result(0, "started"), pose_result(1, 1.0), pose_result(2, 2.5),
       event_result(3, "station_reached", "well_1")});
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

TEST_F(Queries, AStampOfTheFutureDoesNotFreezeARobot) {
  Result ahead = pose_result(1, 9.0), lining_ahead = lining_result(2, 4.0, "run_0");
  ahead.created_ms = lining_ahead.created_ms = kNoon_ms + 1'000'000'000'000;
  add({ahead, lining_ahead});
  Result later = result_of("pose", {{"x", 3.0}, {"y", 2.0}, {"yaw", 0.5}}, 4, "run_2"),
         later_lining = lining_result(5, 12.0, "run_2");
  later.created_ms = later_lining.created_ms = kNoon_ms + 60'000;
  store_.add({later, later_lining}, kNoon_ms + 60'000);
  const Json robot = Json::parse(robots(database()))["robots"][0];
  EXPECT_EQ(robot["x"], 3.0);
  EXPECT_EQ(robot["run"], "run_2");
  EXPECT_EQ(robot["made_ms"], kNoon_ms + 60'000);
  const Json site = Json::parse(lining(database(), "street"));
  EXPECT_EQ(site["scans"][0]["run"], "run_2");
  EXPECT_EQ(site["lines"][0]["change_m"], -0.012);
  EXPECT_EQ(run()["run"], "run_2");
}

TEST_F(Queries, AStampWithinTheToleranceCountsAsItIs) {
  Result ahead = pose_result(1, 9.0);
  ahead.created_ms = kNoon_ms + 50'000 + kClockTolerance_ms;
  add({ahead});
  EXPECT_EQ(Json::parse(robots(database()))["robots"][0]["made_ms"], ahead.created_ms);
}

TEST_F(Queries, ChangesGiveWhatIsNewSinceARevision) {
  add({pose_result(1), event_result(2, "gas_alarm", "well_1")});
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
  add({status_result(0, "started"), event_result(1, "goal_saved", "goal_1")});
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

TEST_F(Queries, RobotsComeInPagesByName) {
  for (int i = 0; i < 450; ++i)
    add({result_of("pose", {{"x", 1.0}, {"y", 0.0}, {"yaw", 0.0}}, 1, "run_1", fmt::format("r{:03}", i))});
  std::set<std::string> names;
  std::string after;
  int num_pages = 0;
  for (bool has_more = true; has_more; ++num_pages) {
    const Json page = Json::parse(robots(database(), {.after = after}));
    ASSERT_LE(page["robots"].size(), 200U);
    for (const Json& robot : page["robots"]) names.insert(after = robot["robot"].get<std::string>());
    has_more = page["more"].get<bool>();
  }
  EXPECT_EQ(num_pages, 3);
  EXPECT_EQ(names.size(), 450U);
  const Json first = Json::parse(changes(database(), 0, kNoon_ms));
  EXPECT_EQ(first["robots"].size(), 200U);
  EXPECT_TRUE(first["more_robots"].get<bool>());
}

TEST_F(Queries, StationsOfARunComeInPages) {
  Json stations = Json::array();
  for (int i = 0; i < 1200; ++i)
    stations.push_back({{"name", fmt::format("s{}", i)}, {"type", "inspect"}, {"position_m", {1.0, 2.0}}});
  add({result_of("status", {{"state", "started"}, {"scenario", "short"}, {"message", ""}, {"stations", stations}}, 0)});
  Json all = Json::array();
  for (Json next = 0; !next.is_null();) {
    const Json page = Json::parse(run_details(database(), "spot-1", "", next.get<std::int64_t>()).value());
    ASSERT_LE(page["stations"].size(), 500U);
    all.insert(all.end(), page["stations"].begin(), page["stations"].end());
    next = page["next_station"];
  }
  EXPECT_EQ(all, stations);
}

/// Lining with 10,000 cells, 900 lines and 900 findings.
Result long_lining(int sequence, const std::string& station) {
  Json data = Json::parse(lining_result(sequence, 12.0).data);
  data["station"] = station;
  Json cell = data["cells"][0], line = data["lines"][0], finding = data["findings"][0];
  for (const char* list : {"cells", "lines", "findings"}) data[list] = Json::array();
  for (int i = 0; i < 10'000; ++i) {
    cell["ring"] = 1 + i / 50;
    cell["clock_deg"] = i % 50;
    data["cells"].push_back(cell);
  }
  for (int i = 0; i < 900; ++i) {
    line["ring"] = finding["ring"] = 1 + i;
    data["lines"].push_back(line);
    data["findings"].push_back(finding);
  }
  return result_of("lining", data, sequence);
}

TEST_F(Queries, ALongLiningComesInPages) {
  add({long_lining(1, "a"), long_lining(2, "b"), lining_result(3, 4.0)});
  std::map<std::int64_t, std::size_t> num_cells;
  std::set<std::pair<int, int>> cells;
  std::size_t num_lines = 0, num_pages = 0;
  std::set<int> rings;
  for (Json next = ""; !next.is_null(); ++num_pages) {
    const std::string text = lining(database(), "street", parse_lining_page(next.get<std::string>()));
    EXPECT_LT(text.size(), 1'000'000U);
    const Json page = Json::parse(text);
    for (const Json& scan : page["scans"]) {
      num_cells[scan["seq"].get<std::int64_t>()] += scan["data"]["cells"].size();
      if (scan["data"]["station"] == "a")
        for (const Json& cell : scan["data"]["cells"])
          cells.emplace(cell["ring"].get<int>(), cell["clock_deg"].get<int>());
    }
    num_lines += page["lines"].size();
    for (const Json& ring : page["rings"]) rings.insert(ring[0].get<int>());
    next = page["next"];
    ASSERT_LT(num_pages, 20U);
  }
  EXPECT_EQ(num_pages, 6U);  // of 4,000 cells each
  EXPECT_EQ(num_cells, (std::map<std::int64_t, std::size_t>{{1, 10'000}, {2, 10'000}, {3, 3}}));
  EXPECT_EQ(cells.size(), 10'000U);
  EXPECT_EQ(num_lines, 900U);
  EXPECT_EQ(rings.size(), 200U);
  for (const char* wrong : {"x", "1", "1.2.3", "1.2.3.4.5", "-1.0.0.0", "1.2.3.x", "9999999999.0.0.0", "1..2.3"})
    EXPECT_THROW(parse_lining_page(wrong), InputError) << wrong;
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
  const Json third = Json::parse(history(
      database(),
      {.robot = "spot-1", .kind = "event", .before = first["results"][24]["seq"].get<std::int64_t>(), .limit = 50}));
  EXPECT_EQ(third["results"].size(), 35U);
  EXPECT_FALSE(third["more"].get<bool>());
  EXPECT_EQ(Json::parse(history(database(), {.robot = "nobody", .kind = ""}))["results"].size(), 0U);
  EXPECT_EQ(Json::parse(history(database(), {.robot = "", .kind = "pose"}))["results"].size(), 25U);
}

}  // namespace
}  // namespace patrol::monitor::queries_test
