#include "app/mapping/consistency_report.h"

#include <gtest/gtest.h>

namespace patrol::app::consistency_report_test {
namespace {

using report::Tone;

/// 100 scans, one per second from the stamp 1000 s on.
ConsistencyReport report_of(const slam::MapConsistency& consistency) {
  ConsistencyReport result{.consistency = consistency, .stamps = {}};
  for (int k = 0; k < 100; ++k) result.stamps.push_back(from_seconds(1000.0 + k));
  return result;
}

TEST(ConsistencyReport, OfAConsistentMapIsGoodAndNamesThePairs) {
  const ConsistencyReport result = report_of({.num_compared = 12, .num_scans = 100, .num_unmatched = 5});
  EXPECT_EQ(result.line(), "consistent: 12 pairs of segments agree, 5.0 % of the scans matched no surfaces");
  EXPECT_EQ(result.block().tone, Tone::kGood);
  EXPECT_TRUE(result.marks().empty());
  EXPECT_EQ(result.metrics()["consistent"], true);
}

TEST(ConsistencyReport, OfADisagreementIsBadAndNamesPlaceAndTimes) {
  const ConsistencyReport result =
      report_of({.num_compared = 12,
                 .disagreements =
                     {{.p_map = {1.5, -2.5}, .first_scan = 7, .second_scan = 90, .offset_m = 1.2, .offset_rad = 0.1}},
                 .num_scans = 100});
  EXPECT_EQ(result.line(),
            "look at (1.5, -2.5): the surfaces seen at 7 s and at 90 s are 1.2 m and 6 deg apart; 1 of 12 pairs of "
            "segments disagree");
  EXPECT_EQ(result.block().word, "look at (1.5, -2.5)");
  EXPECT_EQ(result.block().tone, Tone::kBad);
  EXPECT_EQ(result.block().checks.rows.size(), 1U);
  EXPECT_EQ(result.marks().size(), 1U);
  EXPECT_EQ(result.metrics()["disagreements"][0]["second_s"], 90.0);
}

TEST(ConsistencyReport, OfAThirdOfTheScansUnmatchedIsBadAndNamesTheLongestSegment) {
  const ConsistencyReport result =
      report_of({.num_compared = 12,
                 .num_scans = 90,
                 .num_unmatched = 30,
                 .unmatched_segments = {{.first_scan = 40, .num_scans = 25, .p_map = {3.0, 4.0}},
                                        {.first_scan = 80, .num_scans = 5}}});
  EXPECT_EQ(result.line(), "look at (3.0, 4.0): 33 % of the scans matched no surfaces, at most 25 in a row, from 40 s");
  EXPECT_EQ(result.block().tone, Tone::kBad);
  EXPECT_EQ(result.marks().size(), 1U);
  EXPECT_EQ(result.metrics()["unmatched_segments"][1]["from_s"], 80.0);
}

TEST(ConsistencyReport, OfScansWithoutReturnsNamesTheirRatioAndIsBadAboveAFifth) {
  slam::MapConsistency map{.num_compared = 12, .num_scans = 80, .num_without_returns = 20};
  EXPECT_EQ(report_of(map).line(),
            "consistent: 12 pairs of segments agree, 0.0 % of the scans matched no surfaces, 20.0 % have no returns");
  map.num_scans = 70;
  map.num_without_returns = 30;
  map.max_without_returns = {.first_scan = 20, .num_scans = 25, .p_map = {3.0, 4.0}};
  const ConsistencyReport result = report_of(map);
  EXPECT_EQ(result.line(), "look at (3.0, 4.0): 30 % of the scans have no returns, at most 25 in a row, from 20 s");
  EXPECT_EQ(result.block().tone, Tone::kBad);
  EXPECT_EQ(result.marks().size(), 1U);
  EXPECT_EQ(result.metrics()["consistent"], false);
  EXPECT_EQ(result.metrics()["scans_without_returns"], 30);
}

TEST(ConsistencyReport, OfAFrozenLidarIsBadAndNamesPlaceAndTime) {
  const ConsistencyReport result = report_of(
      {.num_compared = 12,
       .num_scans = 100,
       .frozen = {{.first_scan = 40, .num_scans = 25, .p_map = {3.0, 4.0}}, {.first_scan = 80, .num_scans = 5}}});
  EXPECT_EQ(result.line(),
            "look at (3.0, 4.0): the lidar is frozen: 30 scans repeat the one before while odometry moves, from 40 s");
  EXPECT_EQ(result.marks().size(), 2U);
  EXPECT_EQ(result.metrics()["consistent"], false);
  EXPECT_EQ(result.metrics()["frozen_segments"][1]["scans"], 5);
}

TEST(ConsistencyReport, OfAPathThatNothingSupportsIsBadAndNamesPlaceTimeAndContradiction) {
  const ConsistencyReport result = report_of(
      {.num_compared = 12,
       .num_scans = 100,
       .num_unmatched = 6,
       .unsupported = {{.scans = {.first_scan = 40, .num_scans = 6, .p_map = {3.0, 4.0}}, .contradiction_m = 2.9}}});
  EXPECT_EQ(
      result.line(),
      "look at (3.0, 4.0): from 40 s, 6 scans in a row matched no surfaces, and odometry contradicts 2.9 m of the "
      "path there");
  EXPECT_EQ(result.block().tone, Tone::kBad);
  EXPECT_EQ(result.marks().size(), 1U);
  EXPECT_EQ(result.metrics()["consistent"], false);
  EXPECT_EQ(result.metrics()["unsupported"][0]["contradiction_m"], 2.9);
}

TEST(ConsistencyReport, OfAGapThatOdometryContradictsIsBadAndNamesGapAndContradiction) {
  const ConsistencyReport result = report_of(
      {.num_compared = 12,
       .num_scans = 100,
       .unsupported = {{.scans = {.first_scan = 40, .p_map = {3.0, 4.0}}, .contradiction_m = 9.0, .gap_s = 20.0}}});
  EXPECT_EQ(result.line(),
            "look at (3.0, 4.0): until 40 s, scans are missing for 20.0 s, and odometry contradicts 9.0 m of the path "
            "there");
  EXPECT_EQ(result.metrics()["unsupported"][0]["gap_s"], 20.0);
}

TEST(ConsistencyReport, OfAPartThatOnlyOdometryConnectsIsBadAndNamesPlaceTimeAndDistance) {
  const ConsistencyReport result =
      report_of({.num_compared = 12,
                 .num_scans = 100,
                 .unconnected = {{.first_scan = 40, .p_map = {3.0, 4.0}, .distance_m = 10.4}}});
  EXPECT_EQ(result.line(),
            "look at (3.0, 4.0): from 40 s, only odometry over 10.4 m connects the map with the part before");
  EXPECT_EQ(result.block().tone, Tone::kBad);
  EXPECT_EQ(result.marks().size(), 1U);
  EXPECT_EQ(result.metrics()["consistent"], false);
  EXPECT_EQ(result.metrics()["unconnected"][0]["distance_m"], 10.4);
}

TEST(ConsistencyReport, OfAnUnconnectedPartWithoutPairsIsInconsistent) {
  const ConsistencyReport result =
      report_of({.num_scans = 100, .unconnected = {{.first_scan = 40, .p_map = {3.0, 4.0}, .distance_m = 10.4}}});
  EXPECT_EQ(result.metrics()["consistent"], false);
}

TEST(ConsistencyReport, WithoutPairsIsNotCheckedEvenIfAScanIsUnmatched) {
  const ConsistencyReport result =
      report_of({.num_scans = 100, .num_unmatched = 1, .unmatched_segments = {{.num_scans = 1}}});
  EXPECT_EQ(result.line(), "not checked: no two segments of the path saw the same surfaces");
  EXPECT_EQ(result.block().tone, Tone::kWarning);
  EXPECT_TRUE(result.metrics()["consistent"].is_null());
}

}  // namespace
}  // namespace patrol::app::consistency_report_test
