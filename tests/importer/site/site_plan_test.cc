#include "importer/site/site_plan.h"

#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "sim/mujoco.h"

namespace patrol::importer::site_plan_test {
namespace {

/// Room of 6 x 4 m with thin walls and a ceiling, a table, a low sill and a ramp of 5 degrees; outside is a field.
constexpr const char* kRoom = R"(<mujoco><compiler angle="degree"/><worldbody>
  <geom type="plane" size="20 20 1"/>
  <geom type="box" size="3 0.01 1.25" pos="0 2 1.25"/>
  <geom type="box" size="3 0.01 1.25" pos="0 -2 1.25"/>
  <geom type="box" size="0.01 2 1.25" pos="3 0 1.25"/>
  <geom type="box" size="0.01 2 1.25" pos="-3 0 1.25"/>
  <geom type="box" size="3 2 0.05" pos="0 0 2.55"/>
  <geom type="box" size="0.5 0.5 0.02" pos="1.5 0 0.7"/>
  <geom type="box" size="0.05 1.9 0.02" pos="-1.5 0 0.02"/>
  <geom type="box" size="0.3 0.3 0.05" pos="-2.4 0 1.9"/>
  </worldbody></mujoco>)";

int value_at(const OccupancyGrid& plan, double x, double y) { return plan.at(plan.geometry().cell_at({x, y})); }

TEST(SitePlan, TheGroundOfARoomIsFreeItsWallsAndATableAreOccupiedAndTheFieldOutsideIsUnknown) {
  const sim::ModelPtr site = sim::compile(*sim::parse_spec(kRoom), "room");
  const OccupancyGrid plan = plan_of(*site, Eigen::Vector2d(0.0, 0.5)).map;
  EXPECT_EQ(plan.geometry().resolution_m, 0.05);
  EXPECT_EQ(value_at(plan, 0.0, 0.0), 0);
  EXPECT_EQ(value_at(plan, 2.8, 1.8), 0);
  EXPECT_EQ(value_at(plan, -1.5, 0.0), 0);  // the sill is 4 cm high
  EXPECT_EQ(value_at(plan, -2.4, 0.0), 0);  // the lamp hangs higher than a robot
  EXPECT_EQ(value_at(plan, 1.02, 0.0), 100);
  EXPECT_NE(value_at(plan, 1.5, 0.0), 0);
  EXPECT_NE(value_at(plan, 4.0, 0.0), 0);
  int occupied = 0, free = 0;
  for (const std::int8_t percent : plan.values()) occupied += percent == 100 ? 1 : 0, free += percent == 0 ? 1 : 0;
  EXPECT_NEAR(free * 0.0025, 6.0 * 4.0 - 1.0, 1.0);
  // Walls are crossed once: 20 m of them and 4 m around the table.
  EXPECT_NEAR(occupied, 24.0 / 0.05, 60);
}

TEST(SitePlan, AWallOf2cmAndASheetWithGroundOnBothSidesAreOneOccupiedCellThickAndTheDoorBesideThemIsFree) {
  const sim::ModelPtr site = sim::compile(*sim::parse_spec(R"(<mujoco><worldbody>
  <geom type="plane" size="20 20 1"/>
  <geom type="box" size="0.01 1 1.25" pos="1.003 0 1.25"/>
  <geom type="box" size="1 0.0001 0.5" pos="0 1.491 0.5"/>
  </worldbody></mujoco>)"),
                                          "partitions");
  const OccupancyGrid plan = plan_of(*site, Eigen::Vector2d(0.0, 0.0)).map;
  const auto count_occupied = [&](const Eigen::Vector2d& from, const Eigen::Vector2d& step) {
    int count = 0;
    for (int i = -4; i <= 4; ++i) count += value_at(plan, from.x() + i * step.x(), from.y() + i * step.y()) == 100;
    return count;
  };
  for (const double along : {-0.9, -0.5, 0.0, 0.5, 0.9}) {
    EXPECT_EQ(count_occupied({1.003, along}, {0.05, 0.0}), 1) << along;
    EXPECT_EQ(count_occupied({along, 1.491}, {0.0, 0.05}), 1) << along;
  }
  EXPECT_EQ(count_occupied({1.003, 1.2}, {0.05, 0.0}), 0);
}

/// Plan without a start of geoms on an endless plane, for a robot with a clearance of 0.5 m.
SitePlan plan_on_plane(const std::string& geoms) {
  const sim::ModelPtr site = sim::compile(
      *sim::parse_spec("<mujoco><worldbody><geom type=\"plane\" size=\"0 0 1\"/>" + geoms + "</worldbody></mujoco>"),
      "site");
  return plan_of(*site, std::nullopt);
}

/// Four walls of 2 m around the inside of a square at (x, 0).
std::string square_room(double x, double half_m) {
  std::string walls;
  for (const double side : {-1.0, 1.0}) {
    walls +=
        fmt::format(R"(<geom type="box" size="{0} 0.1 1" pos="{1} {2} 1"/>)", half_m + 0.2, x, side * (half_m + 0.1)) +
        fmt::format(R"(<geom type="box" size="0.1 {0} 1" pos="{1} 0 1"/>)", half_m, x + side * (half_m + 0.1));
  }
  return walls;
}

TEST(SitePlan, WithoutAStartTheInsideOfARoomIsTakenAlsoIfTheMarginAroundItIsLarger) {
  const sim::ModelPtr site = sim::compile(*sim::parse_spec(kRoom), "room");
  for (const double margin_m : {2.0, 10.0}) {
    const SitePlan plan = plan_of(*site, std::nullopt, {}, {.margin_m = margin_m});
    EXPECT_TRUE(plan.is_enclosed);
    EXPECT_EQ(value_at(plan.map, 0.0, 0.0), 0);
    EXPECT_NE(value_at(plan.map, 4.0, 0.0), 0);
  }
  const SitePlan rooms = plan_on_plane(square_room(0.0, 2.0) + square_room(5.0, 2.5));
  EXPECT_TRUE(rooms.is_enclosed);
  EXPECT_EQ(value_at(rooms.map, 5.0, 0.0), 0);
  EXPECT_NE(value_at(rooms.map, 0.0, 0.0), 0);
}

TEST(SitePlan, WithoutAStartTheGroundBetweenHousesIsTakenAndNotTheInsideOfOne) {
  const SitePlan street = plan_on_plane(square_room(0.0, 2.0) + square_room(20.0, 2.0));
  EXPECT_FALSE(street.is_enclosed);
  EXPECT_EQ(value_at(street.map, 10.0, 0.0), 0);
  EXPECT_NE(value_at(street.map, 0.0, 0.0), 0);
  const sim::ModelPtr yard = sim::compile(  // a floor that the file gives, larger than the room on it
      *sim::parse_spec("<mujoco><worldbody><geom type=\"box\" size=\"6 6 0.1\" pos=\"0 0 -0.1\"/>" +
                       square_room(0.0, 2.0) + "</worldbody></mujoco>"),
      "yard");
  EXPECT_EQ(value_at(plan_of(*yard, std::nullopt).map, 5.0, 5.0), 0);
}

TEST(SitePlan, WithoutAStartTheInsideOfASolidIsNeverTaken) {
  const SitePlan block = plan_on_plane(R"(<geom type="box" size="8 8 2" pos="0 0 2"/>)");  // larger than the margin
  EXPECT_EQ(value_at(block.map, 9.0, 0.0), 0);
  EXPECT_NE(value_at(block.map, 0.0, 0.0), 0);
  const SitePlan shell = plan_on_plane(R"(<geom type="box" size="3 3 2" pos="0 0 2" contype="0" conaffinity="0"/>)");
  EXPECT_EQ(value_at(shell.map, 4.0, 0.0), 0);
  EXPECT_FALSE(shell.is_enclosed);
  EXPECT_FALSE(shell.is_too_narrow);
}

TEST(SitePlan, WithoutAStartTheTopOfAnObjectIsNotTaken) {
  const SitePlan plan = plan_on_plane(R"(<geom type="box" size="2 2 0.5" pos="0 0 0.5"/>)");
  EXPECT_FALSE(plan.is_enclosed);
  EXPECT_FALSE(plan.is_too_narrow);
  EXPECT_EQ(value_at(plan.map, 3.0, 0.0), 0);
}

TEST(SitePlan, ARoomWithoutSpaceForTheRobotIsNotTaken) {
  const SitePlan plan = plan_on_plane(square_room(0.0, 0.9));
  EXPECT_FALSE(plan.is_enclosed);
  EXPECT_TRUE(plan.is_too_narrow);
  EXPECT_EQ(value_at(plan.map, 2.0, 0.0), 0);
}

TEST(SitePlan, AStartWithoutGroundAndASiteWithoutGroundAreRefused) {
  const sim::ModelPtr site = sim::compile(
      *sim::parse_spec("<mujoco><worldbody><geom type=\"box\" size=\"1 1 0.1\" pos=\"0 0 1\"/></worldbody></mujoco>"),
      "board");
  EXPECT_EQ(value_at(plan_of(*site, Eigen::Vector2d(0.0, 0.0)).map, 0.5, 0.5), 0);
  EXPECT_THROW(plan_of(*site, Eigen::Vector2d(1.5, 0.0)), InputError);
  EXPECT_THROW(plan_of(*site, Eigen::Vector2d(50.0, 0.0)), InputError);
  const sim::ModelPtr nothing = sim::compile(*sim::parse_spec("<mujoco/>"), "nothing");
  EXPECT_THROW(plan_of(*nothing, std::nullopt), InputError);
}

TEST(SitePlan, AStartInsideOfASolidIsRefusedByItsName) {
  const sim::ModelPtr site = sim::compile(
      *sim::parse_spec("<mujoco><worldbody><geom type=\"plane\" size=\"0 0 1\"/><geom name=\"tank\" type=\"box\" "
                       "size=\"2 2 1.1\" pos=\"6 0 1.1\"/></worldbody></mujoco>"),
      "tank");
  EXPECT_THAT([&] { plan_of(*site, Eigen::Vector2d(6.5, 0.5)); },
              ::testing::ThrowsMessage<InputError>("start (6.50, 0.50): inside of tank"));
  EXPECT_EQ(value_at(plan_of(*site, Eigen::Vector2d(3.5, 0.0)).map, 3.5, 1.0), 0);
  EXPECT_THAT([&] { refuse_start_in_solid(*site, Eigen::Vector2d(6.5, 0.5)); },
              ::testing::ThrowsMessage<InputError>("start (6.50, 0.50): inside of tank"));
  EXPECT_NO_THROW(refuse_start_in_solid(*site, Eigen::Vector2d(3.5, 0.0)));
}

TEST(SitePlan, OnAnEndlessPlaneThePlanContainsStartAndStationsWithAMarginAndNotThoseFarOutside) {
  const sim::ModelPtr site = sim::compile(
      *sim::parse_spec("<mujoco><worldbody><geom type=\"plane\" size=\"0 0 1\"/><geom type=\"box\" size=\"1 1 0.5\" "
                       "pos=\"6 0 0.5\"/></worldbody></mujoco>"),
      "plane");
  const OccupancyGrid plan = plan_of(*site, Eigen::Vector2d(0.0, 0.0), {{-4.0, 0.0}, {6.0, 9.0}, {6.0, 400.0}}).map;
  for (const Eigen::Vector2d& p : {Eigen::Vector2d(-5.9, 0.0), Eigen::Vector2d(6.0, 10.9), Eigen::Vector2d(0.0, 0.0)})
    EXPECT_EQ(value_at(plan, p.x(), p.y()), 0) << p.transpose();
  EXPECT_FALSE(plan.geometry().contains(plan.geometry().cell_at({6.0, 12.0})));
  EXPECT_EQ(plan.geometry().resolution_m, 0.05);
}

TEST(SitePlan, ALargeSiteHasLargerCells) {
  const sim::ModelPtr site = sim::compile(
      *sim::parse_spec("<mujoco><worldbody><geom type=\"box\" size=\"60 50 0.1\"/></worldbody></mujoco>"), "field");
  EXPECT_EQ(plan_of(*site, Eigen::Vector2d(0.0, 0.0)).map.geometry().resolution_m, 0.1);
}

}  // namespace
}  // namespace patrol::importer::site_plan_test
