#include "io/json/inspection_json.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/error.h"

namespace patrol::io::inspection_json_test {
namespace {

using Json = nlohmann::json;

LiningResult small_lining() {
  return {.stamp = Time{1'500'000'001},
          .station = "station_2",
          .T_map_body = {1.0, -2.0, 0.5},
          .is_registered = true,
          .registration_rms_m = 0.002,
          .registration_inlier_ratio = 0.9,
          .correction_m = 0.03,
          .cells = {{.ring = 7, .clock_deg = 355.0, .inward_m = -0.0004, .std_m = 0.0003, .points = 12}},
          .lines = {{.ring = 7, .name = "9-3", .change_m = -0.006, .std_m = 0.0005}},
          .findings = {{.ring = 7,
                        .clock_deg = 60.0,
                        .inward_m = 0.012,
                        .std_m = 0.0004,
                        .level = WarningLevel::kAlarm,
                        .p_map = {10.0, -4.0, 3.0}}}};
}

WaterResult small_water() {
  WaterResult water;
  water.stamp = Time{2};
  water.station = "face";
  water.soundings = 35;
  water.rock_spm = 0.002;
  water.evidence = -3.5;
  water.is_found = true;
  water.level = WarningLevel::kWarning;
  water.p_map = {70.0, 1.0, 2.0};
  water.covariance_m2 << 4.0, 0.5, 0.0, 0.5, 1.0, 0.0, 0.0, 0.0, 2.0;
  water.distance_m = 14.0;
  water.distance_low_m = 12.0;
  water.distance_high_m = 16.5;
  water.azimuth_deg = -20.0;
  water.radius_m = 3.0;
  water.radius_high_m = 4.0;
  return water;
}

/// The sentence with which it is refused.
template <typename Read>
std::string error_text(Read read, const Json& json) {
  try {
    read("result.data", json);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(InspectionJson, LiningComesBackAsItWas) {
  const Json json = to_json(small_lining());
  EXPECT_EQ(to_json(lining_from_json("x", Json::parse(json.dump()))), json);
  const LiningResult back = lining_from_json("x", json);
  EXPECT_EQ(back.stamp.count(), 1'500'000'001);
  EXPECT_EQ(back.cells.at(0).inward_m, -0.0004);
  EXPECT_EQ(back.findings.at(0).level, WarningLevel::kAlarm);
  EXPECT_EQ(back.findings.at(0).p_map, Eigen::Vector3d(10.0, -4.0, 3.0));
  EXPECT_EQ(back.lines.at(0).name, "9-3");
}

TEST(InspectionJson, WaterComesBackAsItWas) {
  const Json json = to_json(small_water());
  EXPECT_EQ(to_json(water_from_json("x", Json::parse(json.dump()))), json);
  EXPECT_EQ(water_from_json("x", json).covariance_m2, small_water().covariance_m2);
  EXPECT_EQ(water_from_json("x", json).distance_high_m, 16.5);
}

TEST(InspectionJson, OfWaterThatWasNotFoundNothingIsSaid) {
  WaterResult none = small_water();
  none.is_found = false;
  const Json json = to_json(none);
  EXPECT_FALSE(json.contains("position_m"));
  EXPECT_FALSE(water_from_json("x", json).is_found);
  Json both = json;
  both["distance_m"] = 3.0;
  EXPECT_EQ(error_text(water_from_json, both), "result.data: unknown key distance_m");
}

TEST(InspectionJson, AFigureThatCouldNotBeComputedIsNull) {
  LiningResult lining = small_lining();
  lining.cells[0].std_m = std::numeric_limits<double>::quiet_NaN();
  const Json json = to_json(lining);
  EXPECT_TRUE(json["cells"][0]["std_m"].is_null());
  EXPECT_TRUE(std::isnan(lining_from_json("x", json).cells.at(0).std_m));
}

TEST(InspectionJson, WhatIsWrongIsNamedWithItsPlaceAndRule) {
  const auto broken = [](const char* pointer, const Json& value) {
    Json json = to_json(small_lining());
    json[Json::json_pointer(pointer)] = value;
    return error_text(lining_from_json, json);
  };
  EXPECT_EQ(broken("/cells/0/ring", 0), "result.data.cells[0]: ring must be in [1, 100000]");
  EXPECT_EQ(broken("/cells/0/clock_deg", 361), "result.data.cells[0]: clock_deg must be in [0, 360]");
  EXPECT_EQ(broken("/cells/0/std_m", -1), "result.data.cells[0]: std_m must not be negative");
  EXPECT_EQ(broken("/findings/0/level", "red"),
            "result.data.findings[0]: level = red: must be one of none, notice, warning, alarm");
  EXPECT_EQ(broken("/findings/0/position_m", {1, 2}),
            "result.data.findings[0]: position_m must be a list of 3 numbers");
  EXPECT_EQ(broken("/lines", "none"), "result.data: lines must be a list");
  EXPECT_EQ(broken("/registered", 1), "result.data: registered must be true or false");
  EXPECT_EQ(broken("/stamp_ns", 1.5), "result.data: stamp_ns must be an integer");
  EXPECT_EQ(broken("/pose/z", 1.5), "result.data.pose: unknown key z; did you mean x?");
}

TEST(InspectionJson, ACovarianceOfTwoRowsIsRefused) {
  Json json = to_json(small_water());
  json["covariance_m2"].erase(2);
  EXPECT_EQ(error_text(water_from_json, json), "result.data: covariance_m2 must be a list of 3 lists of 3 numbers");
}

}  // namespace
}  // namespace patrol::io::inspection_json_test
