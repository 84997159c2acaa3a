#include "stack/mission/station_order.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "inspect/route_frame.h"
#include "io/json/route_json.h"
#include "io/urdf.h"

namespace patrol::stack::station_order_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<std::string> names_of(const StationOrder& order) {
  std::vector<std::string> names;
  for (const Station& station : order.stations) names.push_back(station.name);
  return names;
}

Station pass(const std::string& name, double x, double y, int priority = 0) {
  Station station{.name = name, .type = StationType::kPass, .T_route_body = {x, y, 0.0}};
  station.priority = priority;
  return station;
}

StationOrder order(const Route& route) {
  static const RobotDescription robot =
      io::load_robot_description(PATROL_SOURCE_DIR "/models/quadruped/quadruped.urdf");
  return order_stations(route, robot, {}, {}, 1);
}

TEST(StationOrder, GoesAlongALineWhateverOrderItIsGiven) {
  EXPECT_THAT(names_of(order(
                  {.stations = {pass("c", 9.0, 0.0), pass("a", 3.0, 0.0), pass("d", 12.0, 0.0), pass("b", 6.0, 0.0)}})),
              ElementsAre("a", "b", "c", "d"));
}

// 21 m at 0.7 m/s, and the wait at first.
TEST(StationOrder, SaysHowLongItShouldTake) {
  EXPECT_THAT(order({.stations = {pass("b", 21.0, 0.0), pass("a", 7.0, 0.0)}}).text,
              HasSubstr("in this order: 34 s; optimal"));
}

TEST(StationOrder, TakesALowerPriorityFirstAndHomeLast) {
  Route route{.stations = {pass("near", 3.0, 0.0, 1), pass("home", 0.5, 0.0), pass("far", 12.0, 0.0)}};
  route.stations[1].type = StationType::kHome;
  EXPECT_THAT(names_of(order(route)), ElementsAre("far", "near", "home"));
}

// Behind a kerb 20 m long the neighbour is the farther one.
TEST(StationOrder, KnowsTheWaysRoundKeepOutLines) {
  Route route{.stations = {pass("behind", 3.0, 2.0), pass("along", 6.0, 0.0)}};
  EXPECT_THAT(names_of(order(route)), ElementsAre("behind", "along"));
  route.keep_out_lines = {{{-10.0, 1.0}, {10.0, 1.0}}};
  EXPECT_THAT(names_of(order(route)), ElementsAre("along", "behind"));
}

TEST(StationOrder, KeepsTheGivenOneWhereAStationCannotBeReached) {
  const Route route{.stations = {pass("far", 9.0, 0.0), pass("near", 3.0, 0.0), pass("boxed", 6.0, 0.0)},
                    .keep_out_lines = {{{5.0, -1.0}, {7.0, -1.0}, {7.0, 1.0}, {5.0, 1.0}, {5.0, -1.0}}}};
  const StationOrder kept = order(route);
  EXPECT_THAT(names_of(kept), ElementsAre("far", "near", "boxed"));
  EXPECT_EQ(kept.text, "No order reaches all stations: given order kept.");
}

TEST(StationOrder, OfTheWholeStreetGoesUpOneSideAndLeavesTheWellForItsWindow) {
  const io::RouteFile file = io::load_route(PATROL_SOURCE_DIR "/worlds/street/routes/whole_street.json");
  const Route route = inspect::to_map(file.route, file.T_site_start);
  const std::vector<std::string> names = names_of(order(route));
  ASSERT_EQ(names.size(), route.stations.size());
  EXPECT_EQ(names.back(), "home");
  EXPECT_EQ(names[names.size() - 2], "valve_well_0");
}

}  // namespace
}  // namespace patrol::stack::station_order_test
