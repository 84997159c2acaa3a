#include "io/json/route_json.h"

#include <functional>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "tests/support/pose_near.h"
#include "tests/support/temporary_file.h"

namespace patrol::io::route_json_test {
namespace {

using test::Pose2Near, test::TemporaryFile, test::VectorNear;
using Json = nlohmann::json;

Json make_route() {
  return Json::parse(R"({
    "version": 1, "frame": "site",
    "start": {"position": [11.0, 8.0, 0.0], "orientation": [0, 0, 0.7071067811865476, 0.7071067811865476]},
    "stations": [
      {"number": 1, "name": "box_1", "type": "inspect", "position": [5, 20, 0], "orientation": [0, 0, 1, 0],
       "target": [3, 20, 1.2], "accuracy": 0.2},
      {"number": 2, "name": "home", "type": "home", "position": [11, 8, 0], "orientation": [0, 0, 0, 1], "accuracy": 0.3}],
    "keep_out": [{"name": "kerb", "line": [[9, 4], [9, 20], [7, 20]]}]})");
}

std::string complaint_about_text(const std::string& text) {
  const TemporaryFile file("r.json", text);
  try {
    load_route(file.path());
  } catch (const InputError& error) {
    const std::string what = error.what();
    return what.substr(what.find("r.json"));
  }
  return "";
}

/// Error message of the valid route after a change.
std::string complaint_after(const std::function<void(Json&)>& change) {
  Json route = make_route();
  change(route);
  return complaint_about_text(route.dump());
}

TEST(LoadRoute, ReadsTheDatumAndRefusesOneNearAPole) {
  Json json = make_route();
  EXPECT_FALSE(load_route(TemporaryFile("r.json", json.dump()).path()).datum);
  json["datum"] = {{"latitude_deg", 29.21}, {"longitude_deg", 119.46}};
  const TemporaryFile file("r.json", json.dump());
  const std::optional<GeodeticDatum> datum = load_route(file.path()).datum;
  ASSERT_TRUE(datum);
  EXPECT_EQ(datum->latitude_deg, 29.21);
  EXPECT_EQ(datum->longitude_deg, 119.46);
  EXPECT_THAT(complaint_after([](Json& route) {
                route["datum"] = {{"latitude_deg", 86.0}, {"longitude_deg", 0.0}};
              }),
              ::testing::HasSubstr("latitude_deg must be in [-85, 85]"));
}

TEST(LoadRoute, ReadsStartStationsAndKeepOutLines) {
  const TemporaryFile file("r.json", make_route().dump());
  const RouteFile route = load_route(file.path());
  EXPECT_THAT(route.T_site_start, Pose2Near((Pose2{11.0, 8.0, std::numbers::pi / 2.0}), 0.0, 1e-12));
  ASSERT_EQ(route.route.stations.size(), 2U);
  const Station& box = route.route.stations[0];
  EXPECT_EQ(box.number, 1);
  EXPECT_EQ(box.name, "box_1");
  EXPECT_EQ(box.type, StationType::kInspect);
  EXPECT_THAT(box.T_route_body, Pose2Near((Pose2{5.0, 20.0, std::numbers::pi}), 0.0, 1e-12));
  EXPECT_THAT(box.p_route_target, VectorNear(Eigen::Vector3d(3.0, 20.0, 1.2), 0.0));
  EXPECT_EQ(box.accuracy_m, 0.2);
  ASSERT_EQ(route.route.keep_out_lines.size(), 1U);
  EXPECT_EQ(route.route.keep_out_lines[0].size(), 3U);
}

TEST(LoadRoute, ReadsPriorityAndWindowWhichNobodyMustGive) {
  Json json = make_route();
  json["stations"][0]["priority"] = -2;
  json["stations"][0]["window"] = {60, 90.5};
  const TemporaryFile file("r.json", json.dump());
  const std::vector<Station> stations = load_route(file.path()).route.stations;
  EXPECT_EQ(stations[0].priority, -2);
  EXPECT_EQ(stations[0].earliest_s, 60.0);
  EXPECT_EQ(stations[0].latest_s, 90.5);
  EXPECT_EQ(stations[1].priority, 0);
  EXPECT_EQ(stations[1].latest_s, std::numeric_limits<double>::infinity());
  EXPECT_EQ(complaint_after([](Json& r) {
              r["stations"][0]["window"] = {90, 60};
            }),
            "r.json: stations[0]: window must be two times in s, from 0 to 1e7 and in order");
  EXPECT_EQ(complaint_after([](Json& r) {
              r["stations"][0]["window"] = {0, 1e300};
            }),
            "r.json: stations[0]: window must be two times in s, from 0 to 1e7 and in order");
  EXPECT_EQ(complaint_after([](Json& r) {
              r["stations"][0]["window"] = {-1, 60};
            }),
            "r.json: stations[0]: window must be two times in s, from 0 to 1e7 and in order");
}

TEST(LoadRoute, TheStreetsRoutesAreGood) {
  for (const char* name : {"boxes_and_well.json", "short.json", "whole_street.json"}) {
    const RouteFile route = load_route(std::string(PATROL_SOURCE_DIR "/worlds/street/routes/") + name);
    EXPECT_EQ(route.route.stations.back().type, StationType::kHome);
    EXPECT_FALSE(route.route.keep_out_lines.empty());
  }
}

TEST(LoadRoute, NamesThePlaceOfWhatIsWrong) {
  EXPECT_EQ(complaint_after([](Json& r) { r["version"] = 2; }), "r.json: version must be 1");
  EXPECT_EQ(complaint_after([](Json& r) { r["frame"] = "map"; }), "r.json: frame must be site");
  EXPECT_EQ(complaint_after([](Json& r) { r.erase("start"); }), "r.json: start is missing");
  EXPECT_EQ(complaint_after([](Json& r) { r["stations"][1].erase("name"); }), "r.json: stations[1]: name is missing");
  EXPECT_EQ(complaint_after([](Json& r) { r["stations"][1]["number"] = 1.5; }),
            "r.json: stations[1]: number must be an integer");
  EXPECT_EQ(complaint_after([](Json& r) { r["stations"][0]["type"] = "look"; }),
            "r.json: stations[0]: type = look: must be one of inspect, pass, home");
  EXPECT_EQ(complaint_after([](Json& r) { r["stations"][0]["accuracy"] = 0.0; }),
            "r.json: stations[0]: accuracy must be positive");
  EXPECT_EQ(complaint_after([](Json& r) { r["stations"][0].erase("target"); }),
            "r.json: stations[0]: target is missing: what an inspection looks at");
  EXPECT_EQ(complaint_after([](Json& r) {
              r["stations"][0]["position"] = {1, 2};
            }),
            "r.json: stations[0]: position must be a list of 3 numbers");
  EXPECT_EQ(complaint_after([](Json& r) { r["stations"][0]["position"][1] = nullptr; }),
            "r.json: stations[0]: position must be a list of 3 numbers");
  EXPECT_EQ(complaint_after([](Json& r) {
              r["start"]["orientation"] = {0, 0, 0, 2};
            }),
            "r.json: start: orientation must be a quaternion x, y, z, w of length 1");
  EXPECT_EQ(complaint_after([](Json& r) {
              r["keep_out"][0]["line"] = {{9, 4}};
            }),
            "r.json: keep_out[0]: line must have at least two points");
  EXPECT_EQ(complaint_after([](Json& r) { r["stations"] = 3; }), "r.json: stations must be a list");
  EXPECT_EQ(complaint_after([](Json& r) { r["stations"][0] = 3; }), "r.json: stations[0]: must be an object");
  EXPECT_EQ(complaint_after([](Json& r) { r["keep_out"] = 3; }), "r.json: keep_out must be a list");
  EXPECT_EQ(complaint_after([](Json& r) { r["keep_out"] = {{"name", "x"}}; }), "r.json: keep_out must be a list");
}

TEST(LoadRoute, ReadsAnchorsAndDock) {
  Json json = make_route();
  json["stations"] = Json::array();
  json["anchors"] = Json::parse(R"([{"number": 3, "position": [20.5, -5, 2.5]}])");
  json["dock"] = Json::parse(
      R"({"position": [5, 0, 0], "orientation": [0, 0, 1, 0], "profile": [[0.6, -0.3], [0.7, 0.0], [0.6, 0.3]]})");
  const TemporaryFile file("r.json", json.dump());
  const Route route = load_route(file.path()).route;
  ASSERT_EQ(route.anchors.size(), 1U);
  EXPECT_EQ(route.anchors[0].number, 3);
  EXPECT_THAT(route.anchors[0].p_m, VectorNear(Eigen::Vector3d(20.5, -5.0, 2.5), 0.0));
  ASSERT_TRUE(route.dock.has_value());
  EXPECT_THAT(route.dock->T_route_docked, Pose2Near((Pose2{5.0, 0.0, std::numbers::pi}), 0.0, 1e-12));
  EXPECT_EQ(route.dock->profile_m.size(), 3U);
}

TEST(LoadRoute, WrongAnchorsAndDocksAreNamed) {
  const Json anchor = Json::parse(R"({"number": 3, "position": [20.5, -5, 2.5]})");
  EXPECT_EQ(complaint_after([&](Json& r) {
              r["anchors"] = {anchor, anchor};
            }),
            "r.json: anchors[1]: number 3: duplicate");
  EXPECT_EQ(complaint_after([&](Json& r) {
              r["anchors"] = {{{"number", 3}}};
            }),
            "r.json: anchors[0]: position is missing");
  EXPECT_EQ(complaint_after([&](Json& r) {
              r["dock"] = {{"position", {0, 0, 0}}};
            }),
            "r.json: dock: orientation is missing");
  EXPECT_EQ(complaint_after([&](Json& r) {
              r["dock"] = {{"position", {0, 0, 0}}, {"orientation", {0, 0, 0, 1}}, {"profile", {{1, 2}}}};
            }),
            "r.json: dock: profile must have at least two points");
}

TEST(LoadRoute, UnknownKeysGetTheNearestSpelling) {
  EXPECT_EQ(complaint_after([](Json& r) { r["stations"][0]["acuracy"] = 1; }),
            "r.json: stations[0]: unknown key acuracy; did you mean accuracy?");
  EXPECT_EQ(complaint_after([](Json& r) { r["stazions"] = 1; }),
            "r.json: unknown key stazions; did you mean stations?");
}

// Both would let a robot stand at a station that is not told from another.
TEST(LoadRoute, StationsWithTheSameNameOrNumberAreRefused) {
  EXPECT_EQ(complaint_after([](Json& r) { r["stations"][1]["name"] = "box_1"; }),
            "r.json: stations[1]: name box_1: duplicate");
  EXPECT_EQ(complaint_after([](Json& r) { r["stations"][1]["number"] = 1; }),
            "r.json: stations[1]: number 1: duplicate");
}

TEST(LoadRoute, WhatIsNotJsonIsNamedByItsLine) {
  EXPECT_EQ(complaint_about_text("{\"version\": 1,"), "r.json:1: is not JSON: ends too early");
  EXPECT_EQ(complaint_about_text(""), "r.json:1: is not JSON: ends too early");
  EXPECT_EQ(complaint_about_text("[]"), "r.json: must be an object");
  EXPECT_THROW(load_route("/nowhere/r.json"), InputError);
}

TEST(RouteJson, ItsTextReadsBackAsTheSameStationsAndStart) {
  Route route;
  route.stations = {{.number = 1,
                     .name = "pump",
                     .type = StationType::kInspect,
                     .T_route_body = {1.5, -2.0, 0.7},
                     .p_route_target = {2.0, -2.5, 1.0},
                     .accuracy_m = 0.25,
                     .priority = 3,
                     .earliest_s = 10.0,
                     .latest_s = 90.0},
                    {.number = 2, .name = "home", .type = StationType::kHome, .T_route_body = {0.0, 1.0, -3.0}}};
  const TemporaryFile file("tour.json", to_json_text(route, {4.0, 5.0, 3.1}));
  const RouteFile read = load_route(file.path());
  EXPECT_THAT(read.T_site_start, Pose2Near(Pose2{4.0, 5.0, 3.1}, 1e-12, 1e-12));
  ASSERT_EQ(read.route.stations.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(read.route.stations[i].name, route.stations[i].name);
    EXPECT_EQ(read.route.stations[i].type, route.stations[i].type);
    EXPECT_THAT(read.route.stations[i].T_route_body, Pose2Near(route.stations[i].T_route_body, 1e-12, 1e-12));
    EXPECT_EQ(read.route.stations[i].accuracy_m, route.stations[i].accuracy_m);
  }
  EXPECT_EQ(read.route.stations[0].p_route_target, route.stations[0].p_route_target);
  EXPECT_EQ(read.route.stations[0].priority, 3);
  EXPECT_EQ(read.route.stations[0].earliest_s, 10.0);
  EXPECT_EQ(read.route.stations[0].latest_s, 90.0);
  route.anchors.emplace_back();
  EXPECT_THROW(to_json_text(route, {}), std::invalid_argument);
}

}  // namespace
}  // namespace patrol::io::route_json_test
