#include "inspect/lining/lining_grid.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "core/random.h"
#include "tests/support/lined_tunnel.h"

namespace patrol::inspect::lining_grid_test {
namespace {

LiningInMap lining_in_map() { return {.design = test::LinedTunnel().lining, .invert_m = -0.3}; }

TEST(LiningPoint, PointOfTheIntradosLiesOnTheDesign) {
  const LiningInMap lining = lining_in_map();
  for (const double clock_deg : {0.0, 60.0, 110.0, 250.0, 330.0}) {
    const LiningPoint point = lining_point(lining, lining.intrados(90.0, clock_deg));
    EXPECT_NEAR(point.inward_m, 0.0, 1e-9);
    EXPECT_NEAR(point.chainage_m, 90.0, 1e-9);
    EXPECT_NEAR(point.clock_deg, clock_deg > 180.0 ? clock_deg - 360.0 : clock_deg, 1e-9);
  }
}

TEST(LiningPoint, GradientIsThatOfTheInwardDistance) {
  const LiningInMap lining = lining_in_map();
  for (const double clock_deg : {5.0, 60.0, 105.0, 255.0, 330.0}) {
    for (const double chainage_m : {30.0, 95.0}) {
      const Eigen::Vector3d p = lining.intrados(chainage_m, clock_deg);
      const LiningPoint point = lining_point(lining, p);
      for (int axis = 0; axis < 3; ++axis) {
        constexpr double kStep_m = 1e-5;
        const Eigen::Vector3d step = kStep_m * Eigen::Vector3d::Unit(axis);
        const double slope =
            (lining_point(lining, p + step).inward_m - lining_point(lining, p - step).inward_m) / (2.0 * kStep_m);
        EXPECT_NEAR(point.gradient[axis], slope, 1e-4) << clock_deg << " " << axis;
      }
    }
  }
}

TEST(LiningGrid, HoldsTheRingsWithinReachAndThe23SectorsAboveTheGround) {
  const LiningGrid grid(lining_in_map(), {35.0, -2.0, 0.5}, {});
  // 35 +- 16 m: rings from 20 m to 50 m as a whole.
  EXPECT_EQ(grid.first_ring, 11);
  EXPECT_EQ(grid.rings, 15);
  EXPECT_EQ(grid.sectors(), 23);
  EXPECT_EQ(grid.clock_deg(0), 250.0);
  EXPECT_EQ(grid.clock_deg(11), 0.0);
  EXPECT_EQ(grid.clock_deg(22), 110.0);
}

TEST(LiningGrid, EndsWithTheLining) {
  EXPECT_EQ(LiningGrid(lining_in_map(), {5.0, 0.0, 0.5}, {}).first_ring, 1);
  const LiningGrid last(lining_in_map(), lining_in_map().intrados(97.0, 0.0), {});
  EXPECT_EQ(last.first_ring + last.rings - 1, 50);
  EXPECT_EQ(LiningGrid(lining_in_map(), lining_in_map().intrados(150.0, 0.0), {}).rings, 0);
}

TEST(LiningGrid, TenCentimetresFromAJointBelongToNoCell) {
  const LiningGrid grid(lining_in_map(), {35.0, 0.0, 0.5}, {});
  EXPECT_EQ(grid.cell_at({.chainage_m = 36.09, .clock_deg = 0.0}), -1);
  EXPECT_EQ(grid.cell_at({.chainage_m = 37.91, .clock_deg = 0.0}), -1);
  const int cell = grid.cell_at({.chainage_m = 36.11, .clock_deg = -94.0});
  EXPECT_EQ(grid.ring_of(cell), 19);
  EXPECT_EQ(grid.clock_deg(grid.sector_of(cell)), 270.0);
  EXPECT_EQ(grid.cell_at({.chainage_m = 37.0, .clock_deg = 116.0}), -1);
}

/// Points of the lining with 2 mm of noise, a third of them on things 0.3 m before it.
std::vector<DownsampledPoint> seen(const LiningInMap& lining, double chainage_m) {
  const RandomStream draw(5, "test/seen");
  std::vector<DownsampledPoint> points;
  for (std::uint64_t i = 0; i < 6000; ++i) {
    const double s = chainage_m + 14.0 * (2.0 * draw.uniform(i, 0) - 1.0),
                 clock_deg = 360.0 + 115.0 * (2.0 * draw.uniform(i, 1) - 1.0);
    const Eigen::Vector3d p = lining.intrados(s, std::fmod(clock_deg, 360.0));
    const double inward_m = (i % 3 == 0 ? 0.3 : 0.0) + 0.002 * draw.normal(i, 2);
    points.push_back({.p = p + inward_m * lining_point(lining, p).gradient, .intensity = 0.0, .count = 1});
  }
  return points;
}

TEST(FitDesign, FindsTheLiningThatTheMapHas200mmAsideAnd1DegreeTurned) {
  const LiningInMap lining = lining_in_map();
  const Eigen::Vector3d scanner(85.0, 1.0, 0.5);
  const std::vector<DownsampledPoint> points = seen(lining, 85.0);
  TunnelLining wrong = lining.design;
  wrong.T_route_start = Pose2{0.0, 0.2, 0.0} * Pose2{85.0, 0.0, 0.0} * Pose2{0.0, 0.0, kDegree} *
                        Pose2{-85.0, 0.0, 0.0} * wrong.T_route_start;
  const auto fitted = fit_design(wrong, points, scanner, {});
  ASSERT_TRUE(fitted.has_value());
  EXPECT_NEAR(fitted->invert_m, -0.3, 0.001);
  for (std::size_t i = 1; i < points.size(); i += 100) {
    if (i % 3 != 0) {
      EXPECT_LT(std::abs(lining_point(*fitted, points[i].p).inward_m), 0.01);
    }
  }
}

TEST(FitDesign, OfAHallThatIsNoTunnelThereIsNone) {
  // A ceiling 12 m up, over 10 m by 10 m.
  std::vector<DownsampledPoint> points;
  for (int i = 0; i < 100; ++i) {
    for (int k = 0; k < 100; ++k)
      points.push_back({.p = {80.0 + 0.1 * i, 0.1 * k - 5.0, 12.0}, .intensity = 0.0, .count = 1});
  }
  LiningSettings settings;
  EXPECT_FALSE(fit_design(lining_in_map().design, {}, {85.0, 0.0, 0.5}, settings).has_value());
  for (DownsampledPoint& point : points) point.p.z() = 0.4;  // nothing overhead
  EXPECT_FALSE(fit_design(lining_in_map().design, points, {85.0, 0.0, 0.5}, settings).has_value());
}

}  // namespace
}  // namespace patrol::inspect::lining_grid_test
