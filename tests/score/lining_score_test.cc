#include "score/lining_score.h"

#include <cmath>

#include <gtest/gtest.h>

namespace patrol::score::lining_score_test {
namespace {

/// Ring 3 has moved by 6 mm all round, ring 5 outwards by 4 mm, ring 7 by 2 mm: neither must it be found, nor is it
/// wrong to.
LiningGroundTruth truth() {
  return {.design = {.T_route_start = {},
                     .axis = {{100.0, 0.0}},
                     .crown_radius_m = 5.5,
                     .crown_center_m = 2.5,
                     .side_radius_m = 8.0,
                     .first_ring_m = 0.0,
                     .ring_length_m = 2.0,
                     .rings = 50},
          .invert_m = 0.1,
          .inward_m = [](int ring, double) {
            return ring == 3 ? 0.006 : ring == 5 ? -0.004 : ring == 7 ? 0.002 : 0.0;
          }};
}

RingFinding finding(int ring, double inward_m, const Eigen::Vector3d& p_map = Eigen::Vector3d::Zero()) {
  RingFinding found;
  found.ring = ring;
  found.inward_m = inward_m;
  found.p_map = p_map;
  return found;
}

LiningResult result(std::vector<RingFinding> findings, std::vector<LiningCell> cells = {}) {
  LiningResult made;
  made.station = "D1";
  made.is_registered = true;
  made.findings = std::move(findings);
  made.cells = std::move(cells);
  return made;
}

LiningCell cell(int ring, double inward_m, double std_m) {
  return {.ring = ring, .clock_deg = 90.0, .inward_m = inward_m, .std_m = std_m, .points = 30};
}

TEST(LiningScore, RingPushedBy6mmAndReportedWith7IsFoundWithAnErrorOf1) {
  // The crown of ring 3 is at x = 5, z = 0.1 + 8; map stands 10 m along.
  const LiningScore score =
      lining_score({result({finding(3, 0.007, {-5.0, 0.3, 8.1 - 0.4})})}, truth(), Pose2{10.0, 0.0, 0.0});
  EXPECT_EQ(score.found, 1);
  EXPECT_EQ(score.false_findings, 0);
  EXPECT_NEAR(score.max_error_m, 0.001, 1e-12);
  EXPECT_NEAR(score.max_peak_error_m, 0.001, 1e-12);
  EXPECT_NEAR(score.max_position_error_m, 0.5, 1e-12);  // 0.3 aside, 0.4 down
}

TEST(LiningScore, AResultWithoutAStationIsNotCountedAsOneAndItsFindingsAreEvaluated) {
  LiningResult nameless = result({finding(4, 0.006)});
  nameless.station.clear();
  const LiningScore score = lining_score({nameless, result({})}, truth(), {});
  EXPECT_EQ(score.stations, 1);
  EXPECT_EQ(score.registered, 1);
  EXPECT_EQ(score.false_findings, 1);
}

TEST(LiningScore, MovedRingInViewWithoutAFindingIsMissedAndOneOutOfViewIsNot) {
  const LiningScore score = lining_score({result({}, {cell(3, 0.006, 0.001)})}, truth(), {});
  EXPECT_EQ(score.moved_rings, 1);
  EXPECT_EQ(score.missed, 1);
  ASSERT_EQ(score.rings.size(), 1U);
  EXPECT_EQ(score.rings[0].ring, 3);
  EXPECT_FALSE(score.rings[0].is_found);
}

TEST(LiningScore, FindingOnAStillRingIsFalseAndOnOneMovedBy2mmIsNeither) {
  const LiningScore score = lining_score({result({finding(4, 0.003), finding(7, 0.0021)})}, truth(), {});
  EXPECT_EQ(score.false_findings, 1);
  EXPECT_EQ(score.moved_rings, 0);
  EXPECT_EQ(score.found, 0);
}

TEST(LiningScore, OutwardMoveReportedAsInwardIsAnErrorOf8mm) {
  const LiningScore score = lining_score({result({finding(5, 0.004)})}, truth(), {});
  EXPECT_NEAR(score.max_error_m, 0.008, 1e-12);
  EXPECT_NEAR(score.rings[0].true_peak_m, -0.004, 1e-12);
}

TEST(LiningScore, CellsCountByTheirErrorsAndIntervals) {
  // Errors 1, -1 and 3 mm: root of 11 / 3; with standard deviations of 1 mm the first two intervals hold the truth.
  const LiningScore score =
      lining_score({result({}, {cell(1, 0.001, 0.001), cell(3, 0.005, 0.001), cell(2, 0.003, 0.001)})}, truth(), {});
  EXPECT_EQ(score.cells, 3);
  EXPECT_NEAR(score.cell_rmse_m, std::sqrt(11.0 / 3.0) * 1e-3, 1e-12);
  EXPECT_NEAR(score.cell_coverage_95, 2.0 / 3.0, 1e-12);
}

TEST(LiningScore, StationThatCouldNotBeRegisteredCountsAsNothingElse) {
  LiningResult failed = result({finding(4, 0.003)}, {cell(3, 0.0, 0.001)});
  failed.is_registered = false;
  const LiningScore score = lining_score({failed}, truth(), {});
  EXPECT_EQ(score.stations, 1);
  EXPECT_EQ(score.registered, 0);
  EXPECT_EQ(score.cells, 0);
  EXPECT_EQ(score.false_findings, 0);
}

}  // namespace
}  // namespace patrol::score::lining_score_test
