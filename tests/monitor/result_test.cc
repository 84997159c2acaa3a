#include "monitor/result.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/monitor/sample_results.h"

namespace patrol::monitor::result_test {
namespace {

using Json = nlohmann::json;
using namespace patrol::test;

std::string complaint_about(const std::string& text) {
  try {
    results_from_json(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// With one member changed; a discarded value takes it away.
std::string complaint_with(const char* pointer, const Json& value) {
  Json json = Json::parse(to_json(event_result(7, "gas_alarm", "well_1", 640.0)));
  json[Json::json_pointer(pointer)] = value;
  return complaint_about(json.dump());
}

TEST(Result, ComesBackFromItsJson) {
  const Result result = event_result(7, "gas_alarm", "well_1", 640.0);
  const std::vector<Result> back = results_from_json(to_json(result));
  ASSERT_EQ(back.size(), 1U);
  EXPECT_EQ(back[0].id, "spot-1/run_1/7");
  EXPECT_EQ(to_content(back[0]), to_content(result));
}

TEST(Result, AListIsABatch) {
  EXPECT_EQ(results_from_json("[" + to_json(pose_result(0)) + "," + to_json(pose_result(1)) + "]").size(), 2U);
}

TEST(Result, EachFieldIsHeldToItsRule) {
  EXPECT_EQ(complaint_with("/schema", "patrol-result/1"), "result: schema must be patrol-result/2");
  EXPECT_EQ(complaint_with("/robot", ""), "result: robot must have 1 to 200 bytes");
  EXPECT_EQ(complaint_with("/id", std::string(201, 'x')), "result: id must have 1 to 200 bytes");
  EXPECT_EQ(complaint_with("/run", "a\nb"), "result: run must be a string");
  EXPECT_EQ(complaint_with("/robot",
                           "a\xc2\x9b"
                           "31m"),
            "result: robot must be a string");  // C1: starts a sequence as ESC [ does
  EXPECT_EQ(complaint_with("/robot", "a\x7f"), "result: robot must be a string");
  EXPECT_EQ(complaint_with("/robot",
                           "Gr\xc3\xb6\xc3\x9f"
                           "e"),
            "");
  EXPECT_EQ(complaint_with("/sequence", -1), "result: sequence must not be negative");
  EXPECT_EQ(complaint_with("/time_s", "1"), "result: time_s must be a number");
  EXPECT_EQ(complaint_with("/made_utc", "yesterday"),
            "result: made_utc must be a time such as 2026-11-22T10:45:33.120Z");
  EXPECT_EQ(complaint_with("/kind", "rumour"), "result: kind must be one of event, lining, map, pose, status, water");
  EXPECT_EQ(complaint_with("/colour", "red"), "result: unknown key colour");
  EXPECT_EQ(complaint_with("/data/position_m", {1}), "result.data: position_m must be a list of 2 numbers");
  EXPECT_EQ(complaint_with("/data", {1}), "result.data: must be an object");
}

TEST(Result, WhatIsNoJsonIsRefusedInOneLine) {
  EXPECT_EQ(complaint_about(""), "body:1: is not JSON: ends too early");
  EXPECT_EQ(complaint_about("{\"id\": 1, \"id\": 2}"), "body: id: duplicate key");
  EXPECT_EQ(complaint_about("[" + std::string(30, '[')),
            "body: [0][0][0][0][0][0][0][0][0][0][0][0][0][0][0][0][0][0][0][0]: more than 20 nested levels");
  EXPECT_NE(complaint_about("\"\xff\""), "");
  EXPECT_NE(complaint_about("[1, 2]"), "");
}

TEST(Result, AMapMustBeAPngOfItsSize) {
  const auto map = [](const std::string& base64, int width) {
    return complaint_about(to_json(result_of(
        "map",
        {{"width", width}, {"height", 1}, {"resolution_m", 0.1}, {"origin_m", {0.0, 0.0}}, {"png_base64", base64}},
        1)));
  };
  const char* kTwoByOne =
      "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAAAAADRSSBWAAAAC0lEQVR4nGP4xwAAAf8A/5ijSg0AAAAASUVORK5CYII=";
  EXPECT_EQ(map(kTwoByOne, 2), "");
  EXPECT_EQ(map(kTwoByOne, 3), "result.data: png_base64 must have 3 x 1 pixels, it has 2 x 1");
  const char* kTwoWithTheTopBit = "iVBORw0KGgoAAAANSUhEUoAAAAIAAAABCAAAAADRSSBW";  // width 0x80000002
  EXPECT_EQ(map(kTwoWithTheTopBit, 2), "result.data: png_base64 must be a PNG in base64");
  EXPECT_EQ(map("PHNjcmlwdD4=", 2), "result.data: png_base64 must be a PNG in base64");
}

TEST(Result, OneInABatchRefusesIt) {
  Json bad = Json::parse(to_json(pose_result(1)));
  bad["data"].erase("yaw");
  EXPECT_EQ(complaint_about("[" + to_json(pose_result(0)) + "," + bad.dump() + "]"), "result[1].data: yaw is missing");
}

TEST(Result, ItsSummaryHasTheLengthsOfLongLists) {
  EXPECT_EQ(to_summary(pose_result(1)), pose_result(1).data);
  const Json summary = Json::parse(to_summary(lining_result(1, 4.0)));
  EXPECT_EQ(summary["cells"], 3);
  EXPECT_EQ(summary["findings"], 1);
  EXPECT_EQ(summary["station"], "station_1");
}

TEST(Utc, GoesThereAndBackToTheMillisecond) {
  EXPECT_EQ(to_utc(kNoon_ms + 7), "2026-11-21T12:00:00.007Z");
  EXPECT_EQ(from_utc("2026-11-21T12:00:00.007Z"), kNoon_ms + 7);
  EXPECT_EQ(from_utc("1970-01-01T00:00:00.000Z"), 0);
  for (const char* wrong :
       {"2026-02-29T12:00:00.000Z", "2026-11-21T24:00:00.000Z", "2026-11-21T12:00:00Z", "2026-11-21 12:00:00.000Z",
        "2026-11-21T12:00:00.000+", "+026-11-21T12:00:00.000Z", "2026- 1-21T12:00:00.000Z", "2026-11-21T+1:00:00.000Z",
        "2026-11-21T12:00:00. 07Z", "2026-11-21T12:00:00.-07Z"}) {
    EXPECT_THROW(from_utc(wrong), InputError) << wrong;
  }
}

}  // namespace
}  // namespace patrol::monitor::result_test
