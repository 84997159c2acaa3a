#include "inspect/route_frame.h"

#include <numbers>

#include <gtest/gtest.h>

#include "core/random.h"
#include "tests/support/pose_near.h"

namespace patrol::inspect::route_frame_test {
namespace {

using std::numbers::pi;
using test::Pose2Near;
using test::VectorNear;

constexpr double kExactTol = 1e-12;

Route make_route() {
  Route route;
  route.stations.push_back({.number = 3,
                            .name = "well",
                            .type = StationType::kInspect,
                            .T_route_body = {12.0, 7.0, pi / 2.0},
                            .p_route_target = {12.0, 10.0, 1.5},
                            .accuracy_m = 0.3});
  route.keep_out_lines = {{{10.0, 5.0}, {11.0, 5.0}}, {{0.0, 0.0}}};
  return route;
}

// The robot starts at (10, 5), looking north: east of it is right, so 2 m east and 2 m north are 2 m ahead
// and 2 m to the right.
TEST(RouteFrame, AStartLookingNorthTurnsTheRouteByNinetyDegrees) {
  const Route route = to_map(make_route(), {10.0, 5.0, pi / 2.0});
  EXPECT_THAT(route.stations[0].T_route_body, Pose2Near(Pose2{2.0, -2.0, 0.0}, kExactTol, kExactTol));
  EXPECT_THAT(route.stations[0].p_route_target, VectorNear(Eigen::Vector3d(5.0, -2.0, 1.5), kExactTol));
  EXPECT_THAT(route.keep_out_lines[0][0], VectorNear(Eigen::Vector2d(0.0, 0.0), kExactTol));
  EXPECT_THAT(route.keep_out_lines[0][1], VectorNear(Eigen::Vector2d(0.0, -1.0), kExactTol));
}

TEST(RouteFrame, AnchorsAndDockGoAlong) {
  Route site;
  site.anchors.push_back({.number = 2, .p_m = {12.0, 7.0, 2.5}});
  site.dock = Dock{.T_route_docked = {10.0, 5.0, pi / 2.0}, .profile_m = {{0.6, -0.3}, {0.6, 0.3}}};
  const Route map = to_map(site, {10.0, 5.0, pi / 2.0});
  EXPECT_THAT(map.anchors[0].p_m, VectorNear(Eigen::Vector3d(2.0, -2.0, 2.5), kExactTol));
  EXPECT_THAT(map.dock->T_route_docked, Pose2Near(Pose2{}, kExactTol, kExactTol));
  EXPECT_EQ(map.dock->profile_m[1], Eigen::Vector2d(0.6, 0.3));
}

TEST(RouteFrame, AStartAtTheOriginChangesNothing) {
  const Route route = to_map(make_route(), {});
  EXPECT_THAT(route.stations[0].T_route_body, Pose2Near(Pose2{12.0, 7.0, pi / 2.0}, kExactTol, kExactTol));
  EXPECT_THAT(route.keep_out_lines[0][1], VectorNear(Eigen::Vector2d(11.0, 5.0), kExactTol));
}

TEST(RouteFrame, KeepsWhatHasNoPlace) {
  const Route route = to_map(make_route(), {3.0, 2.0, 1.0});
  ASSERT_EQ(route.stations.size(), 1u);
  EXPECT_EQ(route.stations[0].number, 3);
  EXPECT_EQ(route.stations[0].name, "well");
  EXPECT_EQ(route.stations[0].type, StationType::kInspect);
  EXPECT_EQ(route.stations[0].accuracy_m, 0.3);
  EXPECT_EQ(route.stations[0].p_route_target.z(), 1.5);
  EXPECT_EQ(route.keep_out_lines.size(), 2u);
}

// Into the frame of the start and, with its inverse, back to site.
TEST(RouteFrame, ThereAndBackIsTheRouteAgain) {
  for (std::uint64_t i = 0; i < 50; ++i) {
    const RandomStream stream(i, "test/start");
    const Pose2 T_site_start{20.0 * stream.normal(0), 20.0 * stream.normal(1), 6.28 * stream.uniform(2) - 3.14};
    const Route before = make_route(), after = to_map(to_map(before, T_site_start), T_site_start.inverse());
    const Station &a = before.stations[0], &b = after.stations[0];
    EXPECT_THAT(b.T_route_body, Pose2Near(a.T_route_body, 1e-9, 1e-9));
    EXPECT_THAT(b.p_route_target, VectorNear(a.p_route_target, 1e-9));
    EXPECT_THAT(after.keep_out_lines[0][1], VectorNear(before.keep_out_lines[0][1], 1e-9));
  }
}

}  // namespace
}  // namespace patrol::inspect::route_frame_test
