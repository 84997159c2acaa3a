#include "score/station_error.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "score/map_error.h"

namespace patrol::score::station_error_test {
namespace {

using namespace std::chrono_literals;

/// A corner of two walls through (5, 5): along x at y = 5 and along y at x = 5, cells of 2.5 cm, or only the
/// first.
OccupancyGrid make_walls(bool has_corner = true) {
  OccupancyGrid map({.resolution_m = 0.025, .width = 400, .height = 400}, kFree);
  for (int i = 0; i < 200; ++i) {
    map.at({i, 200}) = kOccupied;
    if (has_corner) map.at({200, i}) = kOccupied;
  }
  return map;
}

DistanceField field_of(const OccupancyGrid& cells) { return DistanceField(occupied_cells(cells)); }

const Eigen::Vector2d kTarget(4.8, 4.8);

TEST(MapDisplacement, OfTheTrueMapIsNone) {
  const auto displacement = map_displacement_m(make_walls(), {}, field_of(make_walls()), kTarget);
  ASSERT_TRUE(displacement);
  EXPECT_LT(*displacement, 0.001);
}

TEST(MapDisplacement, OfAMapTenCentimetresOffIsTenToTwoMillimetres) {
  const auto displacement = map_displacement_m(make_walls(), {0.06, -0.08, 0.0}, field_of(make_walls()), kTarget);
  ASSERT_TRUE(displacement);
  EXPECT_NEAR(*displacement, 0.10, 0.002);
}

// Turned about the origin by half a degree, the target at 6.8 m moves by 5.9 cm; a fit that knew no turn
// would see the mean over the walls.
TEST(MapDisplacement, OfATurnedMapIsThatOfTheTarget) {
  const double expected_m = kTarget.norm() * 2.0 * std::sin(0.25 * kDegree);
  const auto displacement =
      map_displacement_m(make_walls(), {0.0, 0.0, 0.5 * kDegree}, field_of(make_walls()), kTarget);
  ASSERT_TRUE(displacement);
  EXPECT_NEAR(*displacement, expected_m, 0.002);
}

// Beyond half a meter a cell has no part in a fit from the map as it lies.
TEST(MapDisplacement, OfAMapUpToTwoMetersOffIsThatAlongEitherAxisAndDiagonally) {
  const double half = std::sqrt(0.5);
  for (const double off_m : {0.3, 0.5, 0.8, 1.0, 1.3, 1.6, 2.0}) {
    for (const Eigen::Vector2d& direction :
         {Eigen::Vector2d(1.0, 0.0), Eigen::Vector2d(-1.0, 0.0), Eigen::Vector2d(0.0, 1.0), Eigen::Vector2d(0.0, -1.0),
          Eigen::Vector2d(half, half), Eigen::Vector2d(-half, half), Eigen::Vector2d(half, -half),
          Eigen::Vector2d(-half, -half)}) {
      const Pose2 T_world_map{off_m * direction.x(), off_m * direction.y(), 0.0};
      const auto displacement = map_displacement_m(make_walls(), T_world_map, field_of(make_walls()), kTarget);
      ASSERT_TRUE(displacement);
      EXPECT_NEAR(*displacement, off_m, 0.01) << direction.transpose();
    }
  }
}

TEST(MapDisplacement, OfAMapThatIsFarOffAndTurnedIsThatOfTheTarget) {
  for (const double yaw_deg : {-3.0, 3.0}) {
    const Pose2 T_world_map{1.2, -0.9, yaw_deg * kDegree};
    const auto displacement = map_displacement_m(make_walls(), T_world_map, field_of(make_walls()), kTarget);
    const double expected_m = (T_world_map * kTarget - kTarget).norm();
    ASSERT_TRUE(displacement);
    EXPECT_NEAR(*displacement, expected_m, 0.1) << yaw_deg << " degrees";
  }
}

TEST(MapDisplacement, AcrossASingleWallAMeterIsAMeterAndAlongItNothing) {
  const auto displacement =
      map_displacement_m(make_walls(false), {0.2, 1.0, 0.0}, field_of(make_walls(false)), {2.5, 4.8}, 1.5);
  ASSERT_TRUE(displacement);
  EXPECT_NEAR(*displacement, 1.0, 0.01);
}

TEST(MapDisplacement, OfAReferenceWithoutSurfacesThereIsNone) {
  const OccupancyGrid empty({.resolution_m = 0.025, .width = 400, .height = 400}, kFree);
  EXPECT_FALSE(map_displacement_m(make_walls(), {}, field_of(empty), kTarget));
}

TEST(MapDisplacement, AlongASingleWallNothingIsSaid) {
  const Eigen::Vector2d before_the_middle(2.5, 4.8);
  const auto displacement =
      map_displacement_m(make_walls(false), {0.2, 0.05, 0.0}, field_of(make_walls(false)), before_the_middle, 1.5);
  ASSERT_TRUE(displacement);
  EXPECT_NEAR(*displacement, 0.05, 0.002) << "across only";
}

// Two cells of a post against 120 of the wall: what they say along the wall may be a person.
TEST(MapDisplacement, ALonePostDoesNotTellTheLengthOfAWall) {
  OccupancyGrid wall = make_walls(false);
  wall.at({100, 180}) = wall.at({100, 181}) = kOccupied;
  const auto displacement = map_displacement_m(wall, {0.03, 0.05, 0.0}, field_of(wall), {2.5, 4.8}, 1.5);
  ASSERT_TRUE(displacement);
  EXPECT_NEAR(*displacement, 0.05, 0.002);
}

TEST(MapDisplacement, WithFewerThanThirtyCellsThereIsNone) {
  OccupancyGrid map({.resolution_m = 0.025, .width = 400, .height = 400}, kFree);
  for (int i = 0; i < 29; ++i) map.at({180 + i, 200}) = kOccupied;
  EXPECT_FALSE(map_displacement_m(map, {}, field_of(make_walls()), kTarget));
}

Station make_station(const std::string& name, const Pose2& T_route_body) {
  return {.number = 1,
          .name = name,
          .type = StationType::kInspect,
          .T_route_body = T_route_body,
          .p_route_target = {4.8, 4.8, 1.0},
          .accuracy_m = 0.2};
}

Event reached(const std::string& name, Time stamp, const Pose2& T_map_body) {
  return {.stamp = stamp,
          .kind = EventKind::kStationReached,
          .subject = name,
          .text = "",
          .value = 0.0,
          .T_map_body = T_map_body,
          .p_map_target = {}};
}

TEST(StationErrors, TellBeliefTruthAndSurveyApart) {
  const Route route{.stations = {make_station("box_1", {2.0, 1.0, 0.0}), make_station("box_2", {9.0, 1.0, 0.0})},
                    .keep_out_lines = {},
                    .anchors = {},
                    .dock = {}};
  // At 1 s the robot stands at (2, 1.1) heading 3 degrees; it believes (2.03, 1.14) and 5 degrees.
  const Trajectory truth = {{Time(0s), to_pose3({1.0, 1.1, 3.0 * kDegree})},
                            {Time(2s), to_pose3({3.0, 1.1, 3.0 * kDegree})}};
  const Pose2 T_world_map{0.5, 0.0, 0.0};
  const auto errors = station_errors(route, {reached("box_1", 1s, {1.53, 1.14, 5.0 * kDegree})}, T_world_map,
                                     T_world_map, truth, make_walls(), field_of(make_walls()));
  ASSERT_EQ(errors.size(), 2U);
  EXPECT_EQ(errors[0].name, "box_1");
  EXPECT_TRUE(errors[0].is_reached);
  EXPECT_NEAR(errors[0].position_error_m, 0.05, 1e-9);
  EXPECT_NEAR(errors[0].heading_error_deg, 2.0, 1e-9);
  EXPECT_NEAR(errors[0].goal_position_error_m, 0.1, 1e-9);
  EXPECT_TRUE(errors[0].map_error_m);
  EXPECT_EQ(errors[1].name, "box_2");
  EXPECT_FALSE(errors[1].is_reached || errors[1].is_reported);
}

/// Station of a route with one station at (9, 1), by a robot that truly drives from (0, 1) to (10, 1) in 10 s.
StationError error_of_reports(const std::vector<Event>& events) {
  const Route route{.stations = {make_station("box", {9.0, 1.0, 0.0})}};
  const Trajectory truth = {{Time(0s), to_pose3({0.0, 1.0, 0.0})}, {Time(10s), to_pose3({10.0, 1.0, 0.0})}};
  return station_errors(route, events, {}, Pose2{}, truth, make_walls(), field_of(make_walls())).at(0);
}

TEST(StationErrors, AReportFarFromTheTruePositionIsNoArrivalButHasItsErrors) {
  const StationError error = error_of_reports({reached("box", 2s, {9.0, 1.0, 0.0})});
  EXPECT_TRUE(error.is_reported);
  EXPECT_FALSE(error.is_reached);
  EXPECT_NEAR(error.goal_position_error_m, 7.0, 1e-9);
  EXPECT_NEAR(error.position_error_m, 7.0, 1e-9);
}

TEST(StationErrors, ATrueArrivalCountsBesideFalseReports) {
  const StationError error = error_of_reports(
      {reached("box", 2s, {9.0, 1.0, 0.0}), reached("box", 9s, {9.0, 1.0, 0.0}), reached("box", 3s, {9.0, 1.0, 0.0})});
  EXPECT_TRUE(error.is_reached);
  EXPECT_NEAR(error.goal_position_error_m, 0.0, 1e-9);
}

TEST(StationErrors, AReportAfterTheLastGroundTruthIsComparedWithIt) {
  EXPECT_TRUE(error_of_reports({reached("box", 10s + 15ms, {9.0, 1.0, 0.0})}).is_reached);
}

TEST(FitMapToReference, FindsAMapTenCentimetersAndOneDegreeOff) {
  const Pose2 off{0.06, -0.08, 1.0 * kDegree};
  const Pose2 fitted = fit_map_to_reference(make_walls(), std::array{off}, field_of(make_walls()));
  EXPECT_LT(fitted.position().norm(), 0.003);
  EXPECT_NEAR(fitted.yaw, 0.0, 0.02 * kDegree);
}

// Along a single wall the cells fit everywhere.
TEST(FitMapToReference, DoesNotMoveTheMapAlongAWall) {
  const Pose2 off{0.06, -0.08, 0.0};
  const Pose2 fitted = fit_map_to_reference(make_walls(false), std::array{off}, field_of(make_walls(false)));
  EXPECT_NEAR(fitted.x, off.x, 0.005);
  EXPECT_NEAR(fitted.y, 0.0, 0.003);
}

/// Walls of a tunnel of 100 m by 10 m with niches, cells of 10 cm, bent sideways by a sine of this amplitude.
OccupancyGrid make_tunnel(double bend_m, double waves) {
  OccupancyGrid map({.resolution_m = 0.1, .width = 1000, .height = 160}, kFree);
  for (int col = 0; col < 1000; ++col) {
    const int shift = static_cast<int>(std::lround(bend_m / 0.1 * std::sin(2.0 * M_PI * waves * col / 1000.0)));
    const int niche = col % 150 < 20 ? 8 : 0;
    map.at({col, 30 + shift - niche}) = kOccupied;
    map.at({col, 130 + shift + niche}) = kOccupied;
  }
  return map;
}

TEST(FitMapToReference, OfABentTunnelDoesNotFitWorseThanTheStart) {
  const OccupancyGrid straight = make_tunnel(0.0, 1.0);
  const ReferenceMap reference{straight, Grid<std::uint8_t>(straight.geometry(), 1)};
  const DistanceField field = field_of(straight);
  for (const double bend_m : {0.1, 0.3, 0.6, 1.0}) {
    for (const double waves : {0.5, 1.0, 1.5, 2.0, 3.0}) {
      const OccupancyGrid bent = make_tunnel(bend_m, waves);
      const Pose2 fitted = fit_map_to_reference(bent, std::array{Pose2{}}, field);
      EXPECT_LE(map_error(bent, fitted, reference, field).nearest_mean_m,
                map_error(bent, {}, reference, field).nearest_mean_m + 0.02)
          << bend_m << " m, " << waves << " waves";
    }
  }
}

TEST(FitMapToReference, StartsFromTheNearerOfTwoPoses) {
  const std::array<Pose2, 2> starts{Pose2{0.0, 1.4, 1.0 * kDegree}, Pose2{0.05, -0.1, 0.1 * kDegree}};
  const OccupancyGrid tunnel = make_tunnel(0.0, 1.0);
  const Pose2 fitted = fit_map_to_reference(tunnel, starts, field_of(tunnel));
  EXPECT_NEAR(fitted.y, 0.0, 0.02);
  EXPECT_NEAR(fitted.yaw, 0.0, 0.02 * kDegree);
}

TEST(FitMapToReference, OfAnEmptyMapIsWhereItWas) {
  const OccupancyGrid empty(make_walls().geometry(), kFree);
  EXPECT_EQ(fit_map_to_reference(empty, std::array{Pose2{1.0, 2.0, 0.3}}, field_of(make_walls())).vector(),
            Eigen::Vector3d(1.0, 2.0, 0.3));
}

}  // namespace
}  // namespace patrol::score::station_error_test
