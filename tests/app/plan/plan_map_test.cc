#include "app/plan/plan_map.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "io/maps/map_server.h"
#include "tests/support/temporary_file.h"

namespace patrol::app::plan_map_test {
namespace {

class PlanMapTest : public ::testing::Test {
 protected:
  PlanMapTest() {
    io::save_map(folder / "m.yaml",
                 OccupancyGrid({.resolution_m = 0.5, .width = 4, .height = 2, .origin_m = {-1.0, 3.0}}, kFree));
    test::write_bytes(folder / "m.map", "type octile\nheight 2\nwidth 3\nmap\n..W\n@..\n");
  }
  static std::string complaint(const PlanMap& map, const std::string& text) {
    try {
      map.parse_point("--from", text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  test::TemporaryFolder folder;
};

TEST_F(PlanMapTest, PlacesOfAMapServerMapAreMetresInItsFrame) {
  const PlanMap map(folder / "m.yaml");
  EXPECT_EQ(map.parse_point("--from", " -0.75 , 3.25"), Eigen::Vector2d(-0.75, 3.25));
  EXPECT_EQ(map.to_user({-0.75, 3.25}), Eigen::Vector2d(-0.75, 3.25));
  EXPECT_EQ(map.text_of({-0.75, 3.25}), "-0.75, 3.25");
}

TEST_F(PlanMapTest, PlacesOfAMovingAiMapAreCellsFromTheUpperLeft) {
  const PlanMap map(folder / "m.map");
  EXPECT_EQ(map.parse_point("--from", "2,0"), Eigen::Vector2d(2.5, 1.5));
  EXPECT_EQ(map.to_user({2.5, 1.5}), Eigen::Vector2d(2.0, 0.0));
  EXPECT_EQ(map.to_user({2.0, 1.0}), Eigen::Vector2d(1.5, 0.5));  // a corner
  EXPECT_EQ(map.text_of({2.5, 1.5}), "2, 0");
}

TEST_F(PlanMapTest, WhoStandsInWaterSwims) {
  const PlanMap map(folder / "m.map");
  EXPECT_EQ(map.occupancy_from({2.5, 1.5}).at({2, 1}), kFree);
  EXPECT_EQ(map.occupancy_from({2.5, 1.5}).at({0, 1}), kOccupied);
  EXPECT_EQ(map.occupancy_from({0.5, 1.5}).at({2, 1}), kOccupied);
  EXPECT_EQ(map.occupancy_from({0.5, 1.5}).at({0, 1}), kFree);
}

TEST_F(PlanMapTest, WhatLiesOutsideIsRefusedWithTheMapsExtent) {
  const PlanMap metres(folder / "m.yaml"), cells(folder / "m.map");
  EXPECT_EQ(complaint(metres, "400,3"),
            "--from: 400, 3 is outside the map, which spans x -1.00 ... 1.00 m, y 3.00 ... 4.00 m");
  EXPECT_EQ(complaint(metres, "-1,3"), "");  // the lower-left corner is in
  EXPECT_NE(complaint(metres, "1,3"), "");   // the right edge is not
  EXPECT_NE(complaint(metres, "1e300,3"), "");
  EXPECT_EQ(complaint(cells, "3,0"), "--from: 3, 0 is outside the map, which spans x 0 ... 2, y 0 ... 1 (cells)");
  EXPECT_EQ(complaint(cells, "-1,0").substr(0, 31), "--from: -1, 0 is outside the ma");
}

TEST_F(PlanMapTest, WhatIsNoPointIsRefused) {
  const PlanMap metres(folder / "m.yaml"), cells(folder / "m.map");
  for (const char* text : {"nan,3", "1", "1,", ",1", "", "1,2,3", "1;2", "inf,0", "1e999,0", "0x1,3", "a,b"}) {
    EXPECT_EQ(complaint(metres, text), std::string("--from: ") + text + ": must be two numbers, X,Y");
  }
  EXPECT_EQ(complaint(cells, "1.5,0"),
            "--from: 1.5, 0: must be integers, column and row of a cell from the upper left");
}

}  // namespace
}  // namespace patrol::app::plan_map_test
