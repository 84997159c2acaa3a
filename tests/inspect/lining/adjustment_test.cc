#include "inspect/lining/adjustment.h"

#include <cmath>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "tests/support/lining_station.h"

namespace patrol::inspect::adjustment_test {
namespace {

std::vector<DownsampledPoint> points_of(const LiningReference& reference) {
  std::vector<DownsampledPoint> points;
  for (const ScannerPoint& point : reference.points)
    points.push_back({.p = {point.x, point.y, point.z}, .intensity = 0.0, .count = 1});
  return points;
}

/// From 3 mm and 0.3 mrad off, as the registration leaves it.
Adjustment adjusted(const test::LiningStation& station, const LiningSettings& settings = {}) {
  const SurfaceCloud target(points_of(station.reference)),
      source(downsample(station.scan.points, settings.spacing_m, settings.min_range_m));
  const auto lining =
      fit_design(station.design_in_map, target.points(), station.reference.T_map_scanner.position, settings);
  const LiningGrid grid(*lining, station.T_map_scanner.position, settings);
  const Pose3 start{station.T_map_scanner.position + Eigen::Vector3d(0.003, -0.002, 0.001),
                    quaternion_from_yaw(3e-4) * station.T_map_scanner.rotation};
  return adjust(*lining, grid, ReferenceLining(*lining, grid, target.points(), settings), target, source, start,
                station.T_map_scanner_guess, settings);
}

Eigen::Matrix<double, 6, 1> error_of(const Adjustment& adjustment, const Pose3& truth) {
  const Eigen::AngleAxisd turn(truth.rotation * adjustment.T_map_scanner.rotation.conjugate());
  Eigen::Matrix<double, 6, 1> error;
  error << truth.position - adjustment.T_map_scanner.position, turn.angle() * turn.axis();
  return error;
}

TEST(Adjustment, CovarianceHoldsThePoseOver5SeedsWithRingsPushedBy3And12mm) {
  const test::LinedTunnel before = test::LinedTunnel().furnish();
  test::LinedTunnel after = before;
  after.inward_m = [](int ring, double) { return ring == 16 ? 0.003 : ring == 20 ? 0.012 : 0.0; };
  double nees = 0.0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const test::LiningStation station = test::scan_twice(before, after, 35.0, -2.2, seed, 0.6);
    const Adjustment adjustment = adjusted(station);
    const auto error = error_of(adjustment, station.T_map_scanner);
    EXPECT_LT(error.head<3>().norm(), 0.004) << seed;
    EXPECT_LT(error.tail<3>().norm(), 2e-4) << seed;
    const Eigen::Matrix<double, 6, 6> covariance = adjustment.covariance.topLeftCorner<6, 6>();
    nees += error.dot(covariance.ldlt().solve(error)) / 5.0;
  }
  // Six degrees of freedom: 6 on average, of five with a standard deviation of sqrt(12 / 5) = 1.5. It errs on the safe
  // side, since both scans' scatter is counted with the planes' own, but not tenfold.
  EXPECT_LT(nees, 6.0 + 3.0 * 1.5);
  EXPECT_GT(nees, 0.6);
}

TEST(Adjustment, BareTunnelLeavesTheWayAlongItToTheRobotsOwnEstimateOf300mm) {
  test::LinedTunnel bare;
  bare.begin_m = -200.0, bare.end_m = 300.0;
  const test::LiningStation station = test::scan_twice(bare, bare, 40.0, -2.2, 3, 1.0);
  const Adjustment adjustment = adjusted(station);
  const double heading = station.design_in_map.heading_at(40.0);
  const Eigen::Vector3d along(std::cos(heading), std::sin(heading), 0.0), left(-along.y(), along.x(), 0.0);
  const Eigen::Matrix3d covariance_m2 = adjustment.covariance.topLeftCorner<3, 3>();
  EXPECT_GT(std::sqrt(along.dot(covariance_m2 * along)), 0.1);
  EXPECT_LT(std::sqrt(left.dot(covariance_m2 * left)), 0.001);
}

TEST(Adjustment, RangeOffsetOf2mmIsNotTakenForAMove) {
  const test::LinedTunnel tunnel = test::LinedTunnel().furnish();
  test::LiningStation station = test::scan_twice(tunnel, tunnel, 35.0, -2.2, 4, 1.0);
  const double before_m = adjusted(station).range_offset_m;
  for (ScannerPoint& point : station.scan.points) {
    const Eigen::Vector3f p(point.x, point.y, point.z), longer = p + 0.002F * p.normalized();
    point = {longer.x(), longer.y(), longer.z(), point.intensity};
  }
  const Adjustment adjustment = adjusted(station);
  EXPECT_NEAR(adjustment.range_offset_m, before_m + 0.002, 0.0004);  // the prior of 1 mm holds it back a little
  for (const Patch& patch : adjustment.patches) {
    if (patch.cell >= 0) {
      EXPECT_LT(std::abs(patch.offset_m), 0.002);
    }
  }
}

TEST(Adjustment, RingThatHasMovedHasNoWeight) {
  const test::LinedTunnel before = test::LinedTunnel().furnish();
  test::LinedTunnel after = before;
  after.inward_m = [](int ring, double) { return ring == 18 ? 0.006 : 0.0; };
  const test::LiningStation station = test::scan_twice(before, after, 35.0, -2.2, 5, 1.0);
  const Adjustment adjustment = adjusted(station);
  const LiningSettings settings;
  const LiningGrid grid({.design = station.design_in_map, .invert_m = -0.3}, station.T_map_scanner.position, settings);
  double moved = 0.0, still = 0.0;
  int moved_cells = 0, still_cells = 0;
  for (std::size_t i = 0; i < adjustment.patches.size(); ++i) {
    if (adjustment.patches[i].cell < 0) continue;
    const bool is_moved = grid.ring_of(adjustment.patches[i].cell) == 18;
    (is_moved ? moved : still) += adjustment.weights[i];
    ++(is_moved ? moved_cells : still_cells);
  }
  ASSERT_GT(moved_cells, 15);
  EXPECT_LT(moved / moved_cells, 0.01);
  EXPECT_GT(still / still_cells, 0.8);
}

}  // namespace
}  // namespace patrol::inspect::adjustment_test
