#include "app/run/route_extent.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "sim/mujoco.h"

namespace patrol::app::route_extent_test {
namespace {

Route route_to(double x, double y) { return {.stations = {{.name = "goal_1", .T_route_body = {x, y, 0.0}}}}; }

TEST(RouteExtent, AStation40mBesideASiteIsAcceptedAndOneAt395mIsRefusedWithTheExtentOfTheSite) {
  const sim::ModelPtr site = sim::compile(*sim::parse_spec(R"(<mujoco><worldbody>
  <geom type="plane" size="20 20 1"/><geom type="box" size="5 4 1"/>
  <body pos="500 0 0"><freejoint/><geom type="sphere" size="0.1"/></body></worldbody></mujoco>)"),
                                          "hall");
  EXPECT_NO_THROW(require_stations_near(route_to(45.0, 0.0), *site));
  EXPECT_THAT([&] { require_stations_near(route_to(400.0, 0.0), *site); },
              testing::ThrowsMessage<InputError>(
                  "station goal_1: (400, 0) is outside the site: must be at most 50 m from x -5.0 to 5.0 m, y -4.0 to "
                  "4.0 m"));
}

TEST(RouteExtent, ASiteOfAPlaneHasNoEnd) {
  const sim::ModelPtr site = sim::compile(
      *sim::parse_spec("<mujoco><worldbody><geom type=\"plane\" size=\"1 1 1\"/></worldbody></mujoco>"), "plane");
  EXPECT_NO_THROW(require_stations_near(route_to(1000.0, 0.0), *site));
}

}  // namespace
}  // namespace patrol::app::route_extent_test
