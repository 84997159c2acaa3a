#include "inspect/lining/lining_inspection.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/lining_station.h"

namespace patrol::inspect::lining_inspection_test {
namespace {

const Pose3 kT_body_scanner{{-0.2, 0.0, 0.5}, quaternion_from_yaw(0.0)};

LiningResult inspect(const test::LiningStation& station, const LiningSettings& settings = {}) {
  return LiningInspection(settings, station.design_in_map, kT_body_scanner)
      .inspect(Time{}, "D1", station.scan, station.reference, station.T_map_scanner_guess);
}

/// Rings 15, 20 and 22 pushed inwards by 3, 6 and 12 mm, ring 17 bulging by 12 mm at 40 degrees, 40 to both sides.
double moved_m(int ring, double clock_deg) {
  if (ring == 17)
    return std::abs(clock_deg - 40.0) < 40.0
               ? 0.012 * std::pow(std::cos(std::numbers::pi * (clock_deg - 40.0) / 80.0), 2)
               : 0.0;
  return ring == 15 ? 0.003 : ring == 20 ? 0.006 : ring == 22 ? 0.012 : 0.0;
}
double peak_m(int ring) { return moved_m(ring, 40.0); }

class LiningSeeds : public testing::TestWithParam<int> {};

TEST_P(LiningSeeds, PushesOf3And6And12mmAndABulgeAreFoundTo1500MicrometresBesideATruckThatWasNotThereBefore) {
  const test::LinedTunnel before = test::LinedTunnel().furnish();
  test::LinedTunnel after = before;
  after.park_truck(39.0, 1.5).inward_m = moved_m;
  const auto seed = static_cast<std::uint64_t>(GetParam());
  const test::LiningStation station = test::scan_twice(before, after, 35.0, -2.2, seed, 0.6);
  const LiningResult result = inspect(station);
  ASSERT_TRUE(result.is_registered);

  ASSERT_EQ(result.findings.size(), 4U);
  for (const RingFinding& finding : result.findings) {
    EXPECT_NE(peak_m(finding.ring), 0.0) << finding.ring;
    EXPECT_NEAR(finding.inward_m, peak_m(finding.ring), 0.0015) << finding.ring;
    EXPECT_NEAR(finding.inward_m, moved_m(finding.ring, finding.clock_deg), 0.0015) << finding.ring;
  }
  int held = 0;
  for (const LiningCell& cell : result.cells)
    held += std::abs(cell.inward_m - moved_m(cell.ring, cell.clock_deg)) < 1.96 * cell.std_m ? 1 : 0;
  EXPECT_GT(result.cells.size(), 250U);
  EXPECT_GT(held, 0.93 * static_cast<double>(result.cells.size()));
  for (const ConvergenceLine& line : result.lines) {
    if (line.ring == 20 && line.name == "9-3") {
      EXPECT_NEAR(line.change_m, -0.012, 0.0015);
    }
  }
  const Pose2 T_map_body = to_pose2(station.T_map_scanner) * to_pose2(kT_body_scanner).inverse();
  EXPECT_LT((result.T_map_body.position() - T_map_body.position()).norm(), 0.005);
  const double way_m = (station.T_map_scanner.position - station.T_map_scanner_guess.position).norm();
  EXPECT_NEAR(result.correction_m, way_m, 0.005);
}
INSTANTIATE_TEST_SUITE_P(Five, LiningSeeds, testing::Range(1, 6));

class StillSeeds : public testing::TestWithParam<int> {};

/// Five seeds each, so that none takes long.
TEST_P(StillSeeds, WhereNothingHasMovedNothingIsFound) {
  const test::LinedTunnel tunnel = test::LinedTunnel().furnish();
  for (int seed = 5 * GetParam(); seed < 5 * GetParam() + 5; ++seed) {
    const LiningResult result =
        inspect(test::scan_twice(tunnel, tunnel, 84.0, 2.2, static_cast<std::uint64_t>(100 + seed), 0.7));
    EXPECT_TRUE(result.is_registered) << seed;
    EXPECT_GT(result.cells.size(), 200U) << seed;
    EXPECT_TRUE(result.findings.empty()) << seed;
  }
}
INSTANTIATE_TEST_SUITE_P(Twenty, StillSeeds, testing::Range(0, 4));

TEST(LiningInspection, TruckThatHasLeftSinceTheReferenceRaisesNoFinding) {
  const test::LinedTunnel after = test::LinedTunnel().furnish();
  const test::LinedTunnel before = test::LinedTunnel().furnish().park_truck(29.0, 2.0);
  const LiningResult result = inspect(test::scan_twice(before, after, 35.0, -2.2, 7, 0.6));
  EXPECT_TRUE(result.is_registered);
  EXPECT_TRUE(result.findings.empty());
}

TEST(LiningInspection, ReferenceOfAnotherPlaceIsSaidToBeNone) {
  const test::LinedTunnel tunnel = test::LinedTunnel().furnish();
  test::LiningStation station = test::scan_twice(tunnel, tunnel, 35.0, -2.2, 8, 0.8);
  for (const double chainage_m : {43.0, 55.0}) {
    station.scan = test::scan_twice(tunnel, tunnel, chainage_m, -2.2, 9, 0.8).scan;
    const LiningResult result = inspect(station);
    EXPECT_FALSE(result.is_registered) << chainage_m;
    EXPECT_TRUE(result.cells.empty() && result.lines.empty() && result.findings.empty());
  }
}

TEST(LiningInspection, BareTunnelHoldsNothingAlongAndThatIsSaid) {
  const test::LinedTunnel bare;
  EXPECT_FALSE(inspect(test::scan_twice(bare, bare, 50.0, -2.2, 10, 1.0)).is_registered);
}

TEST(LiningInspection, EmptyScanAndEmptyReferenceAreNotRegistered) {
  const test::LinedTunnel tunnel = test::LinedTunnel().furnish();
  test::LiningStation station = test::scan_twice(tunnel, tunnel, 35.0, -2.2, 11, 2.0);
  const PanoramicScan scan = station.scan;
  station.scan.points.clear();
  EXPECT_FALSE(inspect(station).is_registered);
  station.scan = scan;
  station.reference.points.clear();
  EXPECT_FALSE(inspect(station).is_registered);
}

TEST(LiningInspection, SameScansGiveTheSameBits) {
  const test::LinedTunnel tunnel = test::LinedTunnel().furnish();
  const test::LiningStation station = test::scan_twice(tunnel, tunnel, 35.0, -2.2, 12, 0.7);
  const LiningResult one = inspect(station), other = inspect(station);
  ASSERT_GT(one.cells.size(), 200U);
  ASSERT_EQ(one.cells.size(), other.cells.size());
  for (std::size_t i = 0; i < one.cells.size(); ++i) EXPECT_EQ(one.cells[i].inward_m, other.cells[i].inward_m);
}

TEST(LiningInspection, SettingOutOfItsRangeIsNamed) {
  LiningSettings settings;
  settings.sector_deg = 90.0;
  try {
    LiningInspection(settings, test::LinedTunnel().lining, kT_body_scanner);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("lining.sector_deg = 90"), std::string::npos) << error.what();
  }
}

TEST(LiningReference, IsThinnedAndStandsInMap) {
  PanoramicScan scan;
  for (int i = 0; i < 100; ++i) scan.points.push_back({5.0F, 0.001F * static_cast<float>(i) + 0.01F, 0.01F, 40.0F});
  scan.points.push_back({1.0F, 0.0F, 0.0F, 0.0F});   // the robot itself
  scan.points.push_back({50.0F, 0.0F, 0.0F, 0.0F});  // too far
  const LiningReference reference =
      make_reference(scan, {{10.0, 0.0, 0.0}, quaternion_from_yaw(std::numbers::pi / 2.0)});
  ASSERT_GE(reference.points.size(), 1U);
  ASSERT_LE(reference.points.size(), 3U);
  for (const ScannerPoint& point : reference.points) {
    EXPECT_NEAR(point.y, 5.0, 1e-5);
    EXPECT_NEAR(point.x, 10.0, 0.12);
    EXPECT_EQ(point.intensity, 40.0F);
  }
}

}  // namespace
}  // namespace patrol::inspect::lining_inspection_test
