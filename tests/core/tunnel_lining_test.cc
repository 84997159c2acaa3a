#include "core/tunnel_lining.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/geometry/angles.h"

namespace patrol::tunnel_lining_test {
namespace {

/// Straight for 80 m, then to the left with a radius of 400 m; turned and moved in the route's frame.
TunnelLining tunnel() {
  return {.T_route_start = {3.0, -2.0, 0.7},
          .axis = {{80.0, 0.0}, {90.0, 1.0 / 400.0}},
          .crown_radius_m = 5.5,
          .crown_center_m = 2.5,
          .side_radius_m = 8.0,
          .first_ring_m = 0.0,
          .ring_length_m = 2.0,
          .rings = 50};
}

TEST(TunnelLining, PointsAlongStraightAndCurveComeBackAsTheirPlaces) {
  for (const double chainage_m : {-5.0, 0.0, 33.0, 79.9, 80.1, 120.0, 169.0, 180.0}) {
    for (const double left_m : {-4.5, 0.0, 5.2}) {
      const Eigen::Vector2d p = tunnel().point_at(chainage_m, left_m);
      const TunnelCoordinates place = tunnel().to_tunnel_coordinates({p.x(), p.y(), 1.5});
      EXPECT_NEAR(place.chainage_m, chainage_m, 1e-9) << chainage_m << " " << left_m;
      EXPECT_NEAR(place.left_m, left_m, 1e-9) << chainage_m << " " << left_m;
      EXPECT_EQ(place.height_m, 1.5);
    }
  }
}

TEST(TunnelLining, CurveToTheRightMirrorsTheCurveToTheLeft) {
  TunnelLining left = tunnel(), right = tunnel();
  left.T_route_start = right.T_route_start = {};
  right.axis[1].curvature_1pm = -1.0 / 400.0;
  const Eigen::Vector2d p = left.point_at(150.0, 2.0), q = right.point_at(150.0, -2.0);
  EXPECT_NEAR(p.x(), q.x(), 1e-12);
  EXPECT_NEAR(p.y(), -q.y(), 1e-12);
  EXPECT_NEAR(right.to_tunnel_coordinates({q.x(), q.y(), 0.0}).chainage_m, 150.0, 1e-9);
  EXPECT_NEAR(right.to_tunnel_coordinates({q.x(), q.y(), 0.0}).left_m, -2.0, 1e-9);
}

TEST(TunnelLining, ArcOf70mTurnsTheAxisBy70Over400) {
  EXPECT_NEAR(tunnel().heading_at(150.0), 0.7 + 70.0 / 400.0, 1e-12);
  EXPECT_NEAR(tunnel().heading_at(10.0), 0.7, 1e-12);
}

TEST(TunnelLining, ClockRunsFromTheCrownOverTheRightWall) {
  const TunnelLining lining = tunnel();
  EXPECT_NEAR(lining.clock_deg({.left_m = 0.0, .height_m = 8.0}), 0.0, 1e-9);
  EXPECT_NEAR(lining.clock_deg({.left_m = -5.5, .height_m = 2.5}), 90.0, 1e-9);
  EXPECT_NEAR(lining.clock_deg({.left_m = 5.5, .height_m = 2.5}), 270.0, 1e-9);
}

TEST(TunnelLining, IntradosIsTheHalfCircleAboveAndTheSideWallsBelow) {
  const TunnelLining lining = tunnel();
  EXPECT_EQ(lining.radius_at(0.0), 5.5);
  EXPECT_NEAR(lining.radius_at(90.0), 5.5, 1e-12);
  // A side wall's circle: centre 2.5 m beyond the axis at the same height, radius 8 m.
  for (const double clock_deg : {95.0, 110.0, 250.0}) {
    const double radius_m = lining.radius_at(clock_deg), angle = to_rad(clock_deg);
    const double across_m = radius_m * std::abs(std::sin(angle)), up_m = radius_m * std::cos(angle);
    EXPECT_NEAR(std::hypot(across_m + 2.5, up_m), 8.0, 1e-12);
  }
  const TunnelCoordinates place = lining.to_tunnel_coordinates(lining.intrados(101.0, 130.0));
  EXPECT_NEAR(place.chainage_m, 101.0, 1e-9);
  EXPECT_NEAR(lining.clock_deg(place), 130.0, 1e-9);
}

TEST(TunnelLining, RingsAreCountedFromOne) {
  EXPECT_EQ(tunnel().ring_at(-0.01), 0);
  EXPECT_EQ(tunnel().ring_at(0.0), 1);
  EXPECT_EQ(tunnel().ring_at(99.99), 50);
  EXPECT_EQ(tunnel().ring_at(100.0), 0);
  EXPECT_EQ(tunnel().middle_of_ring_m(3), 5.0);
}

}  // namespace
}  // namespace patrol::tunnel_lining_test
