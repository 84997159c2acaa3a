#include "importer/site/free_space.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"

namespace patrol::importer::free_space_test {
namespace {

/// Two rooms of 4 x 4 and 3 x 4 m, a closed wall between them, unknown around.
OccupancyGrid two_rooms() {
  OccupancyGrid plan({.resolution_m = 0.1, .width = 90, .height = 60, .origin_m = {-1.0, -1.0}}, -1);
  for (int row = 10; row < 50; ++row) {
    for (int col = 10; col < 80; ++col) plan.at({col, row}) = col == 50 ? 100 : 0;
  }
  return plan;
}

TEST(FreeSpace, IsTheLargestRegionWithItsClearanceToWallsAndToUnknownCells) {
  const FreeSpace space(two_rooms(), 0.5, std::nullopt);
  EXPECT_TRUE(space.contains({2.0, 2.0}));
  EXPECT_TRUE(space.contains({0.55, 2.0}));
  EXPECT_FALSE(space.contains({0.35, 2.0}));  // unknown from 0 m on
  EXPECT_FALSE(space.contains({3.65, 2.0}));  // wall at 4.0 to 4.1 m
  EXPECT_FALSE(space.contains({5.5, 2.0}));   // the smaller room
  EXPECT_FALSE(space.contains({50.0, 2.0}));
}

TEST(FreeSpace, OfAStartIsTheRegionNearestToIt) {
  const FreeSpace space(two_rooms(), 0.5, Eigen::Vector2d(6.9, 3.9));
  EXPECT_TRUE(space.contains({5.5, 2.0}));
  EXPECT_FALSE(space.contains({2.0, 2.0}));
}

/// Room of 4 x 4 m with a door of 0.8 m, and 2 m of ground around it up to the border of the plan.
OccupancyGrid room_with_door() {
  OccupancyGrid plan({.resolution_m = 0.1, .width = 84, .height = 84, .origin_m = {-4.2, -4.2}}, 0);
  for (int i = 21; i < 63; ++i) {
    for (const Cell cell : {Cell{i, 21}, Cell{i, 62}, Cell{21, i}}) plan.at(cell) = 100;
    if (i < 38 || i >= 46) plan.at({62, i}) = 100;
  }
  return plan;
}

TEST(FreeSpace, IsInsideOfWallsWhereTheGroundOutsideIsOnlyTheMarginBehindANarrowDoor) {
  const FreeSpace space(room_with_door(), 0.5, std::nullopt, 2.0);
  EXPECT_TRUE(space.is_enclosed());
  EXPECT_TRUE(space.contains({0.0, 0.0}));
  EXPECT_FALSE(space.contains({3.2, 0.0}));
  const FreeSpace given(room_with_door(), 0.5, std::nullopt);
  EXPECT_FALSE(given.is_enclosed());
  EXPECT_TRUE(given.contains({3.2, 0.0}));
  const FreeSpace through_the_door(room_with_door(), 0.3, std::nullopt, 2.0);
  EXPECT_FALSE(through_the_door.is_enclosed());
  EXPECT_TRUE(through_the_door.contains({3.2, 0.0}));
}

TEST(FreeSpace, APlaceOfLessThan1SquareMeterInsideOfWallsIsNotTaken) {
  EXPECT_FALSE(FreeSpace(room_with_door(), 1.7, std::nullopt, 2.0).is_enclosed());
  EXPECT_NEAR(area_with_clearance_m2(two_rooms(), 0.5), 3.0 * 3.0 + 1.9 * 3.0, 1e-9);
}

TEST(FreeSpace, ThroughADoorOfNineCellsARobotOfItsWidthPassesAndAWiderOneDoesNot) {
  OccupancyGrid plan = room_with_door();
  plan.at({62, 46}) = 0;
  const Eigen::Vector2d inside(0.0, 0.0);
  EXPECT_TRUE(FreeSpace(plan, 0.45, inside).contains({3.2, 0.0}));
  EXPECT_FALSE(FreeSpace(plan, 0.46, inside).contains({3.2, 0.0}));
}

TEST(ClearanceProblem, IsADistanceToTheFacesOfWallsBelowTheLimit) {
  EXPECT_FALSE(clearance_problem(two_rooms(), 0.5, {3.5, 2.0}));  // wall at 4.0 to 4.1 m
  EXPECT_EQ(clearance_problem(two_rooms(), 0.5, {3.51, 2.0}),
            "0.49 m from walls or unknown space: the robot needs at least 0.50 m");
}

TEST(FreeSpace, WithoutRoomForTheClearanceIsRefused) {
  EXPECT_THROW(FreeSpace(two_rooms(), 2.5, std::nullopt), InputError);
}

TEST(RandomStations, AreInTheRegionApartFromEachOtherAndTheSameForTheSameSeed) {
  const FreeSpace space(two_rooms(), 0.3, std::nullopt);
  const Pose2 start{2.0, 2.0, 1.0};
  const std::vector<Station> stations = random_stations(space, start, 5, 3, 1.0);
  ASSERT_EQ(stations.size(), 6u);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_TRUE(space.contains(stations[i].T_route_body.position()));
    EXPECT_GE((stations[i].T_route_body.position() - start.position()).norm(), 1.0);
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GE((stations[i].T_route_body.position() - stations[j].T_route_body.position()).norm(), 1.0);
    }
  }
  EXPECT_EQ(stations[5].type, StationType::kHome);
  EXPECT_EQ(stations[5].T_route_body.yaw, 1.0);
  EXPECT_EQ(random_stations(space, start, 5, 3, 1.0)[4].T_route_body.x, stations[4].T_route_body.x);
  EXPECT_NE(random_stations(space, start, 5, 4, 1.0)[4].T_route_body.x, stations[4].T_route_body.x);
}

TEST(RandomStations, TooManyForTheirSeparationAreDrawnCloser) {
  const FreeSpace space(two_rooms(), 0.3, std::nullopt);
  EXPECT_EQ(random_stations(space, {2.0, 2.0, 0.0}, 60, 1, 3.0).size(), 61u);
}

TEST(StationsAlong, APathOf3MetersHaveItsSpacingAndSkipPosesOutsideTheRegion) {
  const FreeSpace space(two_rooms(), 0.3, std::nullopt);
  std::vector<Pose2> path;
  for (int i = 0; i <= 300; ++i) path.push_back({0.5 + 0.01 * i, 2.0, 0.0});
  const std::vector<Station> stations = stations_along(path, space, 1.0);
  ASSERT_EQ(stations.size(), 3u);
  EXPECT_NEAR(stations[0].T_route_body.x, 1.5, 0.011);
  EXPECT_NEAR(stations[1].T_route_body.x, 2.5, 0.011);
  EXPECT_NEAR(stations[2].T_route_body.x, 3.5, 0.011);
  EXPECT_EQ(stations[2].type, StationType::kHome);
  EXPECT_THROW(stations_along({{20.0, 0.0, 0.0}, {22.0, 0.0, 0.0}}, space, 1.0), InputError);
}

}  // namespace
}  // namespace patrol::importer::free_space_test
