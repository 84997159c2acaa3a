#include "realism/scan_alignment.h"

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "realism/expected_scan.h"
#include "realism/scan_positions.h"
#include "tests/realism/sites.h"

namespace patrol::realism {
namespace {

using test::kPi;

/// Scan of the site with a constant range error, at a pose that is wrong by `error`.
PosedScan scan_off_by(const Site& site, PosedScan posed, const Eigen::Vector3d& error, double bias_m) {
  const std::vector<ExpectedBeam> expected = expected_beams(site, posed, {});
  for (std::size_t i = 0; i < expected.size(); ++i)
    posed.scan.ranges_m[i] = static_cast<float>(expected[i].range_m + bias_m);
  return corrected(posed, error);
}

TEST(AlignScan, RecoversAnErrorOfThePathInAClosedRoomToAMillimeter) {
  const Site site = test::site_of(test::room());
  const Eigen::Vector3d error(0.05, -0.03, 1.0 * kDegree);
  const ScanAlignment aligned =
      align_scan(site, scan_off_by(site, test::posed_scan(360, 2.0 * kPi, {0.5, 0.2, 0.7}), error, 0.0), {}, {});
  EXPECT_NEAR(aligned.correction.x(), -0.05, 1e-3);
  EXPECT_NEAR(aligned.correction.y(), 0.03, 1e-3);
  EXPECT_NEAR(aligned.correction.z(), -1.0 * kDegree, 3e-4);
  EXPECT_GE(aligned.num_beams, 300u);
}

TEST(AlignScan, AbsorbsNoConstantRangeErrorInAClosedRoomAndAllOfItAtOneWall) {
  const Site closed = test::site_of(test::room()), open = test::site_of(test::box("4.5 0 0", "0.5 40 3"));
  const ScanAlignment in_room = align_scan(closed, scan_off_by(closed, test::posed_scan(360), {0, 0, 0}, 0.03), {}, {});
  EXPECT_LE(in_room.absorbed_bias, 0.01);
  EXPECT_LE(in_room.correction.head<2>().norm(), 1e-3);
  // A field of view of 10 degrees onto one wall: the bias is a shift along the normal.
  AlignmentSettings loose;
  loose.position_std_m = 10.0;
  const ScanAlignment at_wall =
      align_scan(open, scan_off_by(open, test::posed_scan(100, 10.0 * kDegree), {0, 0, 0}, 0.03), {}, loose);
  EXPECT_GE(at_wall.absorbed_bias, 0.99);
  EXPECT_NEAR(at_wall.correction.x(), -0.03, 1e-3);
}

TEST(PositionScans, RangeErrorsComeOutBesideErrorsOfThePathOf5CentimetersAnd1Degree) {
  const Site site =
      test::site_of(test::room() + test::box("3.0 2.0 0", "0.2 0.3 3") + test::box("-2.0 -2.2 0", "0.3 0.2 3"));
  const sim::LidarErrors planted{.range_offset_m = 0.03, .range_scale = 0.002};
  std::vector<PosedScan> scans;
  for (int k = 0; k < 12; ++k) {
    PosedScan posed = test::posed_scan(360, 2.0 * kPi, {-1.5 + 0.25 * k, -0.6 + 0.1 * k, 0.5 * k});
    const std::vector<ExpectedBeam> expected = expected_beams(site, posed, {});
    for (std::size_t i = 0; i < expected.size(); ++i)
      posed.scan.ranges_m[i] =
          static_cast<float>(expected[i].range_m + planted.range_error_m(expected[i].range_m, 0.5, 1.0));
    const double sign = k % 2 == 0 ? 1.0 : -1.0;
    scans.push_back(corrected(posed, {0.05 * sign, -0.05, sign * 1.0 * kDegree}));
  }
  const PositionedScans positioned = position_scans(site, scans, {});
  EXPECT_NEAR(positioned.errors.range_offset_m, 0.03, 0.001);
  EXPECT_NEAR(positioned.errors.range_scale, 0.002, 0.0003);
  for (std::size_t k = 0; k < scans.size(); ++k) EXPECT_NEAR(positioned.corrections[k].y(), 0.05, 0.002) << k;
}

TEST(AlignScan, KeepsThePoseOfAScanWithFewReturns) {
  const Site site = test::site_of(test::room());
  AlignmentSettings settings;
  settings.min_beams = 1000;
  const ScanAlignment aligned =
      align_scan(site, scan_off_by(site, test::posed_scan(360), {0.05, 0, 0}, 0.0), {}, settings);
  EXPECT_EQ(aligned.correction, Eigen::Vector3d::Zero());
}

}  // namespace
}  // namespace patrol::realism
