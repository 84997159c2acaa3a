#include "stack/localization/site_follower.h"

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "tests/support/pose_near.h"

namespace patrol::stack::site_follower_test {
namespace {

const Pose2 kStart{11.0, 8.0, to_rad(90.0)};

Route survey_in_map() {
  Route route;
  route.stations = {{.name = "far", .T_route_body = {70.0, 5.0, 0.2}, .p_route_target = {72.0, 5.0, 1.0}}};
  route.keep_out_lines = {{{0.0, 2.0}, {80.0, 2.0}}};
  return route;
}

TEST(SiteFollower, KeepsTheSurveyWhileItMovesLessThanTheMinimum) {
  SiteFollower follower(survey_in_map(), kStart, 0.03);
  EXPECT_FALSE(follower.update({.T_site_map = kStart}));
  EXPECT_FALSE(follower.update({.T_site_map = kStart * Pose2{0.02, 0.0, 0.0}}));
  EXPECT_TRUE(follower.update({.T_site_map = kStart * Pose2{0.04, 0.0, 0.0}}));
  EXPECT_FALSE(follower.update({.T_site_map = kStart * Pose2{0.05, 0.0, 0.0}}));  // 1 cm more
}

// The survey stands in site: with the map turned to the left, it lies turned to the right in the map.
TEST(SiteFollower, MovesTheSurveyAgainstTheMap) {
  SiteFollower follower(survey_in_map(), kStart, 0.03);
  const Pose2 T_start_map{0.02, -0.01, to_rad(0.5)};
  const std::optional<Route> moved = follower.update({.T_site_map = kStart * T_start_map});
  ASSERT_TRUE(moved);
  const Route before = survey_in_map();
  EXPECT_THAT(T_start_map * moved->stations[0].T_route_body,
              test::Pose2Near(before.stations[0].T_route_body, 1e-9, 1e-9));
  EXPECT_THAT(T_start_map * moved->keep_out_lines[0][1], test::VectorNear(before.keep_out_lines[0][1], 1e-9));
  EXPECT_LT(moved->stations[0].T_route_body.y, before.stations[0].T_route_body.y - 0.5);
}

}  // namespace
}  // namespace patrol::stack::site_follower_test
