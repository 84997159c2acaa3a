#include "sim/static_obstacles.h"

#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "core/error.h"
#include "sim/lidar_scene.h"
#include "sim/mujoco.h"

namespace patrol::sim::static_obstacles_test {
namespace {

ModelPtr world_with(const std::vector<StaticObstacleSettings>& obstacles) {
  const SpecPtr spec = parse_spec("<mujoco/>");
  add_static_obstacles(*spec, obstacles);
  return compile(*spec, "obstacles");
}

/// Height of what is seen straight below (x, y); nothing below 1 m.
double seen_height(const mjModel& model, double x, double y) {
  const LidarScene scene(model);
  const auto hit = scene.cast({x, y, 2.0}, {0, 0, -1}, 3.0, kRayEverything);
  return hit ? 2.0 - hit->distance_m : -1.0;
}

LowObstacleSettings twenty_on_a_bent_route() {
  return {.count = 20,
          .route = {{0.0, 0.0}, {60.0, 0.0}, {60.0, 50.0}},
          .end_clearance_m = 4.0,
          .max_lateral_offset_m = 0.5,
          .min_spacing_m = 2.0};
}

TEST(StaticObstacles, EachKindHasOneTouchableGeomUnderItsNumberAndIsSeenAtItsHeight) {
  for (const char* kind : {"rebar", "kerb", "hose", "brick"}) {
    const ModelPtr model = world_with({{.kind = kind, .x_m = 3.0, .y_m = -1.0, .yaw_deg = 0.0}});
    int touchable = 0;
    for (int geom = 0; geom < model->ngeom; ++geom) {
      if (model->geom_contype[geom] == 0) continue;
      ++touchable;
      EXPECT_STREQ(mj_id2name(model.get(), mjOBJ_GEOM, geom), "static_obstacle_1") << kind;
      EXPECT_EQ(model->geom_conaffinity[geom], 2) << kind;
    }
    EXPECT_EQ(touchable, 1) << kind;
    const double height = static_obstacle_size(kind).height_m;
    EXPECT_NEAR(seen_height(*model, 3.0, -1.0), height, 1e-6) << kind;
    EXPECT_GE(height, 0.06);
    EXPECT_LE(height, 0.25) << "a lidar at 0.35 m must look over it";
  }
}

TEST(StaticObstacles, AKerbTurnedBy90DegreesIsLongAlongY) {
  const ModelPtr model = world_with({{.kind = "kerb", .x_m = 5.0, .y_m = 2.0, .yaw_deg = 90.0}});
  EXPECT_NEAR(seen_height(*model, 5.0, 2.45), 0.22, 1e-6);  // half its length is 0.5 m
  EXPECT_LT(seen_height(*model, 5.45, 2.0), 0.0);
}

TEST(StaticObstacles, AHoseTurnedBy30DegreesLiesThere) {
  const ModelPtr model = world_with({{.kind = "hose", .x_m = 0.0, .y_m = 0.0, .yaw_deg = 30.0}});
  const double c = std::cos(std::numbers::pi / 6.0), s = 0.5;
  EXPECT_NEAR(seen_height(*model, 0.7 * c, 0.7 * s), 0.10, 1e-6);
  EXPECT_NEAR(seen_height(*model, -0.7 * c, -0.7 * s), 0.10, 1e-6);
  EXPECT_LT(seen_height(*model, 0.7 * c, -0.7 * s), 0.0);
}

// Its nose points to +y: the cab's roof is 2.86 m up, the tub's rear edge 2.05 m, the wheels stand on the ground.
TEST(StaticObstacles, ATruckTurnedBy90DegreesStandsOnItsWheelsNoseTo90DegreesAndIsTouchedAsOneHull) {
  const ModelPtr model = world_with({{.kind = "truck", .x_m = 5.0, .y_m = 2.0, .yaw_deg = 90.0}});
  const LidarScene scene(*model);
  const auto height = [&](double x, double y) {
    const auto hit = scene.cast({x, y, 4.0}, {0, 0, -1}, 5.0, kRayEverything);
    return hit ? 4.0 - hit->distance_m : -1.0;
  };
  EXPECT_NEAR(height(5.0, 2.0 + 3.2), 2.86, 1e-6);
  EXPECT_NEAR(height(5.0, 2.0 - 3.74), 2.05, 1e-6);
  EXPECT_LT(height(5.0 + 1.5, 2.0), 0.0);
  EXPECT_LT(height(5.0, 2.0 + 3.9), 0.0);
  const auto across_wheel = scene.cast({9.0, 2.0 + 2.75, 0.02}, {-1, 0, 0}, 9.0, kRayEverything);
  ASSERT_TRUE(across_wheel);
  EXPECT_NEAR(across_wheel->distance_m, 4.0 - 1.02 - 0.19, 1e-6) << "rubber, 2 cm above the ground";
  EXPECT_FALSE(scene.cast({9.0, 2.0 + 0.5, 0.2}, {-1, 0, 0}, 9.0, kRayEverything)) << "one can look through below it";
  int touchable = 0;
  for (int geom = 0; geom < model->ngeom; ++geom) touchable += model->geom_contype[geom] != 0;
  EXPECT_EQ(touchable, 1);
  EXPECT_EQ(model->geom_group[mj_name2id(model.get(), mjOBJ_GEOM, "static_obstacle_1")], 3);
  EXPECT_EQ(static_obstacle_size("truck").height_m, 3.0);
}

TEST(LowObstacles, NoneIsATruck) {
  const LowObstacleSettings settings{.count = 200,
                                     .route = {{0.0, 0.0}, {900.0, 0.0}},
                                     .end_clearance_m = 0.0,
                                     .max_lateral_offset_m = 0.5,
                                     .min_spacing_m = 1.0};
  for (const StaticObstacleSettings& obstacle : scatter_low_obstacles(settings, 4)) EXPECT_NE(obstacle.kind, "truck");
}

TEST(StaticObstacles, AnUnknownKindIsRefusedByItsPlaceInTheList) {
  const SpecPtr spec = parse_spec("<mujoco/>");
  try {
    add_static_obstacles(*spec, {{.kind = "kerb"}, {.kind = "sofa"}});
    FAIL() << "a sofa was taken";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "static_obstacles.1.kind = sofa: must be one of rebar, kerb, hose, brick, truck");
  }
}

TEST(LowObstacles, TwentyLieWithinHalfAMetreOfTheRouteTwoMetresApartAndClearOfItsEnds) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto obstacles = scatter_low_obstacles(twenty_on_a_bent_route(), seed);
    ASSERT_EQ(obstacles.size(), 20u);
    double last_along = 4.0 - 1.0;  // the first part begins 4 m on, and half of `apart` of it is left free
    for (const StaticObstacleSettings& obstacle : obstacles) {
      const double from_first = std::abs(obstacle.y_m), from_second = std::abs(obstacle.x_m - 60.0);
      EXPECT_LE(std::min(from_first, from_second), 0.5);
      const double along = from_first <= 0.5 && obstacle.x_m <= 60.0 ? obstacle.x_m : 60.0 + obstacle.y_m;
      EXPECT_GE(along - last_along, 2.0 - 0.5 - 1e-9);  // at the bend, beside the route is along it
      last_along = along;
    }
    EXPECT_LE(last_along, 110.0 - 4.0 - 1.0);
  }
}

TEST(LowObstacles, AllKindsComeUpAndOffsetsAreUniformWithinFourStandardErrors) {
  const LowObstacleSettings settings{.count = 1000,
                                     .route = {{0.0, 0.0}, {9000.0, 0.0}},
                                     .end_clearance_m = 0.0,
                                     .max_lateral_offset_m = 0.5,
                                     .min_spacing_m = 1.0};
  std::set<std::string> kinds;
  double sum = 0.0, sum_of_squares = 0.0;
  for (const StaticObstacleSettings& obstacle : scatter_low_obstacles(settings, 3)) {
    kinds.insert(obstacle.kind);
    sum += obstacle.y_m;
    sum_of_squares += obstacle.y_m * obstacle.y_m;
  }
  EXPECT_EQ(kinds.size(), 4u);
  const double n = 1000.0, variance = 1.0 / 12.0;  // of a uniform variable one metre wide
  EXPECT_LT(std::abs(sum / n), 4.0 * std::sqrt(variance / n));
  EXPECT_LT(std::abs(sum_of_squares / n - variance), 4.0 * std::sqrt((1.0 / 80.0 - variance * variance) / n));
}

TEST(LowObstacles, TheSameSeedGivesTheSameAndAnotherSeedOthers) {
  const auto first = scatter_low_obstacles(twenty_on_a_bent_route(), 7),
             again = scatter_low_obstacles(twenty_on_a_bent_route(), 7);
  const auto other = scatter_low_obstacles(twenty_on_a_bent_route(), 8);
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_EQ(first[i].x_m, again[i].x_m);
    EXPECT_EQ(first[i].yaw_deg, again[i].yaw_deg);
    EXPECT_NE(first[i].yaw_deg, other[i].yaw_deg);
  }
}

TEST(LowObstacles, ARouteTooShortForThemIsRefusedWithItsLength) {
  LowObstacleSettings settings = twenty_on_a_bent_route();
  settings.route.pop_back();  // 60 m: 52 m between the ends, 2.6 m for each
  EXPECT_EQ(scatter_low_obstacles(settings, 1).size(), 20u);
  settings.min_spacing_m = 3.0;
  try {
    scatter_low_obstacles(settings, 1);
    FAIL() << "20 obstacles 3 m apart in 52 m";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "low_obstacles.route: length 60.0 m: too short for 20 obstacles with min_spacing_m = 3 and "
                 "end_clearance_m = 4");
  }
}

}  // namespace
}  // namespace patrol::sim::static_obstacles_test
