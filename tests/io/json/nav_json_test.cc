#include "io/json/nav_json.h"

#include <functional>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "tests/support/pose_near.h"
#include "tests/support/temporary_file.h"

namespace patrol::io::nav_json_test {
namespace {

using test::Pose2Near, test::TemporaryFile;
using Json = nlohmann::json;

Json make_nav() {
  return Json::parse(R"([
    {"number": 1, "position": [35, 1.5, 0], "orientation": [0, 0, 0, 1], "type": "N", "accuracy": 0.1},
    {"number": 2, "position": [75, -2, 0], "orientation": [0, 0, 1, 0], "type": "V", "accuracy": 0.5}])");
}

std::string complaint_about(const std::string& text) {
  const TemporaryFile file("nav.json", text);
  try {
    load_nav(file.path());
  } catch (const InputError& error) {
    const std::string what = error.what();
    return what.substr(what.find("nav.json"));
  }
  return "";
}

std::string complaint_after(const std::function<void(Json& goal)>& change) {
  Json nav = make_nav();
  change(nav[1]);
  return complaint_about(nav.dump());
}

TEST(LoadNav, ReadsTheFieldsOfPaper004) {
  const TemporaryFile file("nav.json", make_nav().dump());
  const std::vector<SavedGoal> goals = load_nav(file.path());
  ASSERT_EQ(goals.size(), 2U);
  EXPECT_EQ(goals[1].number, 2);
  EXPECT_THAT(goals[1].T_map_body, Pose2Near((Pose2{75.0, -2.0, std::numbers::pi}), 0.0, 1e-12));
  EXPECT_EQ(goals[1].type, GoalType::kVia);
  EXPECT_EQ(goals[1].accuracy_m, 0.5);
}

TEST(LoadNav, WhatWasSavedIsReadBack) {
  const TemporaryFile file("nav.json", "");
  save_nav(file.path(), {{.number = 4, .T_map_body = {1.25, -2.5, 0.75}, .type = GoalType::kVia, .accuracy_m = 0.3}});
  const std::vector<SavedGoal> goals = load_nav(file.path());
  ASSERT_EQ(goals.size(), 1U);
  EXPECT_EQ(goals[0].number, 4);
  EXPECT_THAT(goals[0].T_map_body, Pose2Near((Pose2{1.25, -2.5, 0.75}), 1e-12, 1e-12));
  EXPECT_EQ(goals[0].type, GoalType::kVia);
}

TEST(LoadNav, EachMissingFieldIsNamed) {
  for (const char* key : {"number", "position", "orientation", "type", "accuracy"}) {
    EXPECT_EQ(complaint_after([&](Json& goal) { goal.erase(key); }),
              std::string("nav.json: [1]: ") + key + " is missing");
  }
}

TEST(LoadNav, EachWrongTypeIsNamed) {
  EXPECT_EQ(complaint_after([](Json& goal) { goal["number"] = 1.5; }), "nav.json: [1]: number must be an integer");
  EXPECT_EQ(complaint_after([](Json& goal) { goal["number"] = 1e300; }), "nav.json: [1]: number must be an integer");
  EXPECT_EQ(complaint_after([](Json& goal) { goal["number"] = 9007199254740993; }),
            "nav.json: [1]: number is too large");
  EXPECT_EQ(complaint_after([](Json& goal) { goal["number"] = 18446744073709551615u; }),
            "nav.json: [1]: number is too large")
      << "2^64 - 1 is no -1";
  EXPECT_EQ(complaint_after([](Json& goal) { goal["number"] = std::numeric_limits<std::int64_t>::min(); }),
            "nav.json: [1]: number is too large");
  EXPECT_EQ(complaint_after([](Json& goal) {
              goal["position"] = {1, 2};
            }),
            "nav.json: [1]: position must be a list of 3 numbers");
  EXPECT_EQ(complaint_after([](Json& goal) { goal["orientation"] = "north"; }),
            "nav.json: [1]: orientation must be a list of 4 numbers");
  EXPECT_EQ(complaint_after([](Json& goal) { goal["type"] = 7; }), "nav.json: [1]: type must be a string");
  EXPECT_EQ(complaint_after([](Json& goal) { goal["type"] = std::string("N\0", 2); }),
            "nav.json: [1]: type must be a string");
  EXPECT_EQ(complaint_after([](Json& goal) { goal["accuracy"] = "0.1"; }), "nav.json: [1]: accuracy must be a number");
}

TEST(LoadNav, NumbersThatMeanNothingAreRefused) {
  EXPECT_EQ(complaint_after([](Json& goal) {
              goal["position"] = {1, nullptr, 0};
            }),  // how JSON writes NaN
            "nav.json: [1]: position must be a list of 3 numbers");
  EXPECT_EQ(complaint_after([](Json& goal) {
              goal["orientation"] = {0, 0, 0, 0};
            }),
            "nav.json: [1]: orientation must be a quaternion x, y, z, w of length 1");
  EXPECT_EQ(complaint_after([](Json& goal) {
              goal["orientation"] = {1, 0, 0, 0};
            }),  // w first: on its head
            "nav.json: [1]: orientation must be upright within 45 degrees: a quaternion x, y, z, w");
  EXPECT_EQ(complaint_after([](Json& goal) { goal["accuracy"] = 0; }), "nav.json: [1]: accuracy must be positive");
  EXPECT_EQ(complaint_after([](Json& goal) { goal["type"] = "X"; }),
            "nav.json: [1]: type = X: must be one of N, V, D, R");
  EXPECT_EQ(complaint_after([](Json& goal) { goal["number"] = 1; }), "nav.json: [1]: number 1: duplicate");
  EXPECT_EQ(complaint_about("[{\"number\": NaN}]"), "nav.json:1: is not JSON at column 13");
  EXPECT_EQ(complaint_about("[{\"number\": 1e999}]"), "nav.json:1: 1e999: number out of range");
}

TEST(LoadNav, NoGoalAndAMillionGoalsAreRefused) {
  EXPECT_EQ(complaint_about("[]"), "nav.json: must be a list of at least one goal");
  EXPECT_EQ(complaint_about("{}"), "nav.json: must be a list of at least one goal");
  std::string many = "[{}";
  for (int i = 1; i < 1000000; ++i) many += ",{}";
  EXPECT_EQ(complaint_about(many + "]"), "nav.json: more than 1000 entries");
}

}  // namespace
}  // namespace patrol::io::nav_json_test
