#include "score/inspection_score.h"

#include <numbers>

#include <gtest/gtest.h>

namespace patrol::score::inspection_score_test {
namespace {

Event alarm_at(double x, double y, const std::string& station = "box_2") {
  return {.stamp = {},
          .kind = EventKind::kGasAlarm,
          .subject = station,
          .text = "",
          .value = 500.0,
          .T_map_body = {},
          .p_map_target = {x, y}};
}

const std::vector<LeakGroundTruth> kLeaks = {{"leak_a", {10.0, 0.0}}, {"leak_b", {20.0, 0.0}}};

TEST(InspectionScore, AnAlarmHalfAMetreFromALeakFindsIt) {
  const InspectionScore score = inspection_score({alarm_at(10.3, 0.4)}, {}, kLeaks);
  EXPECT_EQ(score.leaks, 2);
  EXPECT_EQ(score.leaks_found, 1);
  EXPECT_EQ(score.false_alarms, 0);
  ASSERT_EQ(score.findings.size(), 1U);
  EXPECT_EQ(score.findings[0].leak, "leak_a");
  EXPECT_EQ(score.findings[0].station, "box_2");
  EXPECT_EQ(score.findings[0].column_ppm_m, 500.0);
  EXPECT_NEAR(score.findings[0].error_m, 0.5, 1e-12);
}

TEST(InspectionScore, AnAlarmMoreThanTwoMetresFromEveryLeakIsFalse) {
  const InspectionScore score = inspection_score({alarm_at(12.1, 0.0), alarm_at(11.9, 0.0)}, {}, kLeaks);
  EXPECT_EQ(score.false_alarms, 1);
  EXPECT_EQ(score.leaks_found, 1);
}

TEST(InspectionScore, TwoAlarmsAboutOneLeakFindOne) {
  const InspectionScore score = inspection_score({alarm_at(10.0, 0.5), alarm_at(10.0, -0.5)}, {}, kLeaks);
  EXPECT_EQ(score.leaks_found, 1);
  EXPECT_EQ(score.findings.size(), 2U);
}

TEST(InspectionScore, TheNearestOfTwoLeaksIsMeant) {
  EXPECT_EQ(inspection_score({alarm_at(15.4, 0.0)}, {}, kLeaks, 6.0).findings[0].leak, "leak_b");
  EXPECT_EQ(inspection_score({alarm_at(14.6, 0.0)}, {}, kLeaks, 6.0).findings[0].leak, "leak_a");
}

TEST(InspectionScore, PlacesAreTakenFromMapToWorld) {
  const InspectionScore score =
      inspection_score({alarm_at(0.0, -9.0)}, Pose2{1.0, 0.0, std::numbers::pi / 2.0}, kLeaks);
  EXPECT_NEAR(score.findings[0].error_m, 0.0, 1e-9);
}

TEST(InspectionScore, OtherEventsAreNoAlarms) {
  Event measured = alarm_at(10.0, 0.0);
  measured.kind = EventKind::kGasMeasured;
  const InspectionScore score = inspection_score({measured}, {}, kLeaks);
  EXPECT_EQ(score.leaks_found, 0);
  EXPECT_TRUE(score.findings.empty());
}

}  // namespace
}  // namespace patrol::score::inspection_score_test
