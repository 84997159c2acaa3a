#include "importer/site/site_import.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "io/json/route_json.h"
#include "io/maps/map_png.h"
#include "io/maps/map_server.h"
#include "io/yaml/settings_yaml.h"
#include "sim/lidar_scene.h"
#include "sim/mujoco.h"
#include "tests/support/temporary_file.h"

namespace patrol::importer::site_import_test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// Room of 4 x 3 m between walls of one cell of 10 cm, with a door of 1 m in the east wall; (0, 0) is its middle.
OccupancyGrid room_plan() {
  OccupancyGrid plan({.resolution_m = 0.1, .width = 60, .height = 50, .origin_m = {-3.0, -2.5}}, -1);
  for (int row = 9; row <= 40; ++row) {
    for (int col = 9; col <= 50; ++col) {
      const bool is_edge = row == 9 || row == 40 || col == 9 || col == 50;
      const bool is_door = col == 50 && row >= 20 && row < 30;
      plan.at({col, row}) = is_edge && !is_door ? 100 : 0;
    }
  }
  return plan;
}

class PlanImport : public ::testing::Test {
 protected:
  PlanImport() { io::save_map(folder_ / "room.yaml", room_plan()); }

  SiteImportOptions options(const MissionOptions& mission = {}) const {
    return {.file = folder_ / "room.yaml", .name = "room", .wall_height_m = 2.0, .mission = mission};
  }

  test::TemporaryFolder folder_;
};

TEST_F(PlanImport, WritesASiteWhoseWallsALidarSeesWithin1MillimeterAndLeavesTheDoorOpen) {
  write_site(import_site(options()), folder_ / "worlds/room");
  const sim::ModelPtr model = sim::compile(*sim::load_spec(folder_ / "worlds/room/room.xml"), "room");
  const sim::LidarScene scene(*model);
  const auto range_m = [&](double azimuth_rad, double height_m) {
    const auto hit = scene.cast({0.0, 0.0, height_m}, {std::cos(azimuth_rad), std::sin(azimuth_rad), 0.0}, 30.0,
                                sim::kRayEverything);
    return hit ? hit->distance_m : -1.0;
  };
  EXPECT_NEAR(range_m(M_PI, 0.3), 2.0, 1e-3);
  EXPECT_NEAR(range_m(M_PI / 2.0, 0.3), 1.5, 1e-3);
  EXPECT_NEAR(range_m(-M_PI / 2.0, 1.99), 1.5, 1e-3);
  EXPECT_EQ(range_m(M_PI, 2.01), -1.0);
  EXPECT_EQ(range_m(0.0, 0.3), -1.0);
  EXPECT_NEAR(range_m(0.5, 0.3), 2.0 / std::cos(0.5), 1e-3);
  const auto floor = scene.cast({0.0, 0.0, 1.0}, {0.0, 0.0, -1.0}, 3.0, sim::kRayEverything);
  ASSERT_TRUE(floor);
  EXPECT_NEAR(floor->distance_m, 1.0, 1e-6);
}

TEST_F(PlanImport, KeepsThePlanAsTheMapAndTheDefaultGroundRules) {
  write_site(import_site(options()), folder_ / "worlds/room");
  EXPECT_EQ(io::load_map(folder_ / "worlds/room/map/map.yaml").values(), room_plan().values());
  const auto settings = io::load_settings<sim::SiteSettings>(folder_ / "worlds/room/room.yaml", {});
  EXPECT_EQ(settings.ground.max_step_m, 0.25);
  EXPECT_TRUE(settings.ground.all.geoms.empty());
  EXPECT_THAT(test::read_bytes(folder_ / "worlds/room/README.md"), HasSubstr("--wall-height"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "worlds/room/scenarios"));
}

TEST_F(PlanImport, APngHasTheWallsOfThePgm) {
  const ImportedSite of_pgm = import_site(options());
  std::filesystem::remove(folder_ / "room.pgm");
  test::write_bytes(folder_ / "room.png", io::map_png(room_plan()));
  test::write_bytes(folder_ / "room.yaml", "image: room.png\nresolution: 0.1\norigin: [-3, -2.5, 0]\nnegate: 0\n");
  const ImportedSite of_png = import_site(options());
  EXPECT_EQ(of_png.map->values(), of_pgm.map->values());
  EXPECT_EQ(of_png.shapes.size(), of_pgm.shapes.size());
}

TEST_F(PlanImport, RandomStationsAreAMissionInTheFreeSpaceOfThePlan) {
  write_site(import_site(options({.num_random = 3, .seed = 5, .clearance_m = 0.4, .robot = "tracked"})),
             folder_ / "worlds/room");
  const io::RouteFile mission = io::load_route(folder_ / "worlds/room/routes/patrol.json");
  ASSERT_EQ(mission.route.stations.size(), 4u);
  for (const Station& station : mission.route.stations) {
    EXPECT_LE(std::abs(station.T_route_body.x), 2.2);
    EXPECT_LE(std::abs(station.T_route_body.y), 1.2);
  }
  const std::string scenario = test::read_bytes(folder_ / "worlds/room/scenarios/patrol.yaml");
  EXPECT_THAT(scenario, HasSubstr("robot: tracked\n"));
  EXPECT_THAT(scenario, HasSubstr("expect:\n  mission.completed: true\n  mission.collisions: {max: 0}\n"));
}

TEST_F(PlanImport, ATableOfStationsIsAMissionThatEndsAtTheLastOneAndFacesAwayFromTheOneBefore) {
  test::write_bytes(folder_ / "stations.csv", "name,x,y,heading_deg\npump,1.0,0.0,\nvalve,1.0,1.0,180\n");
  const ImportedSite site = import_site(options({.stations = folder_ / "stations.csv", .start = Pose2{}}));
  ASSERT_TRUE(site.route);
  ASSERT_EQ(site.route->stations.size(), 2u);
  EXPECT_EQ(site.route->stations[0].name, "pump");
  EXPECT_EQ(site.route->stations[0].type, StationType::kPass);
  EXPECT_NEAR(site.route->stations[0].T_route_body.yaw, 0.0, 1e-12);
  EXPECT_NEAR(site.route->stations[1].T_route_body.yaw, M_PI, 1e-12);
  EXPECT_EQ(site.route->stations[1].type, StationType::kHome);
}

TEST_F(PlanImport, WithoutAStartATableStartsAtItsFirstStationTowardTheSecondWithARowThatNamesTheOption) {
  test::write_bytes(folder_ / "stations.csv", "name,x,y\npump,1.0,-0.5\nvalve,1.0,0.5\n");
  const ImportedSite site = import_site(options({.stations = folder_ / "stations.csv"}));
  EXPECT_EQ(site.T_site_start.x, 1.0);
  EXPECT_EQ(site.T_site_start.y, -0.5);
  EXPECT_NEAR(site.T_site_start.yaw, 0.5 * M_PI, 1e-12);
  EXPECT_NEAR(site.route->stations[0].T_route_body.yaw, 0.5 * M_PI, 1e-12);
  EXPECT_EQ(site.assumptions.back().subject, "start");
  EXPECT_EQ(site.assumptions.back().override_with, "--start");
}

TEST_F(PlanImport, StationsOutsideInAWallWithTooLittleClearanceOrBehindAWallAreRefusedWithTheirLine) {
  OccupancyGrid plan = room_plan();
  for (int row = 9; row <= 40; ++row) plan.at({20, row}) = 100;
  io::save_map(folder_ / "room.yaml", plan);
  const auto expect_refusal = [&](const std::string& row, const std::string& what) {
    test::write_bytes(folder_ / "s.csv", "name,x,y\npump,1,0\n" + row + "\n");
    EXPECT_THAT([&] { import_site(options({.stations = folder_ / "s.csv"})); },
                ThrowsMessage<InputError>(HasSubstr("s.csv:3: valve: (" + what)));
  };
  expect_refusal("valve,400,0", "400, 0): outside the floor plan");
  expect_refusal("valve,1,1.55", "1, 1.55): in a wall or an obstacle");
  expect_refusal("valve,-2.5,0", "-2.5, 0): not on the free ground");
  expect_refusal("valve,1,1.3", "1, 1.3): 0.20 m from walls or unknown space: the robot needs at least 0.50 m");
  expect_refusal("valve,-1.5,0", "-1.5, 0): not connected to the start");
}

TEST_F(PlanImport, StationsBehindAPassageThatIsTooNarrowForTheRobotAreReported) {
  OccupancyGrid plan = room_plan();
  for (int row = 9; row <= 40; ++row) plan.at({20, row}) = row >= 20 && row < 26 ? 0 : 100;  // door of 0.6 m
  io::save_map(folder_ / "room.yaml", plan);
  test::write_bytes(folder_ / "s.csv", "name,x,y\npump,1,0\nvalve,-1.5,0\n");
  const auto row_with = [&](double half_width_m) {
    const ImportedSite site =
        import_site(options({.stations = folder_ / "s.csv", .clearance_m = 0.4, .half_width_m = half_width_m}));
    for (const Assumption& row : site.assumptions) {
      if (row.subject == "passages") return row.text;
    }
    return std::string();
  };
  EXPECT_EQ(row_with(0.35), "1 of 2 stations are behind passages narrower than 0.70 m, the width of the robot: valve");
  EXPECT_EQ(row_with(0.2), "");
}

TEST_F(PlanImport, AStartOutsideOrInAWallIsRefusedWithATableAndWithRandomStations) {
  test::write_bytes(folder_ / "s.csv", "name,x,y\npump,1,0\n");
  for (MissionOptions mission : {MissionOptions{.stations = folder_ / "s.csv"}, MissionOptions{.num_random = 1}}) {
    mission.start = Pose2{40.0, 0.0, 0.0};
    EXPECT_THAT([&] { import_site(options(mission)); },
                ThrowsMessage<InputError>(HasSubstr("--start 40,0: outside the floor plan")));
    mission.start = Pose2{-2.05, 0.0, 0.0};
    EXPECT_THAT([&] { import_site(options(mission)); },
                ThrowsMessage<InputError>(HasSubstr("--start -2.05,0: in a wall")));
  }
}

/// Imports a MuJoCo model of a closed room of 5 x 5 m on an endless plane.
ImportedSite import_room(const MissionOptions& mission) {
  const test::TemporaryFolder folder;
  test::write_bytes(folder / "scene.xml", R"(<mujoco><worldbody><geom type="plane" size="0 0 0.1"/>
<geom name="north" type="box" size="2.6 0.1 1" pos="0 2.6 1"/><geom type="box" size="2.6 0.1 1" pos="0 -2.6 1"/>
<geom type="box" size="0.1 2.6 1" pos="2.6 0 1"/><geom type="box" size="0.1 2.6 1" pos="-2.6 0 1"/>
</worldbody></mujoco>)");
  return import_site({.file = folder / "scene.xml", .name = "scene", .mission = mission});
}

std::string row_of(const ImportedSite& site, const std::string& subject) {
  for (const Assumption& row : site.assumptions) {
    if (row.subject == subject) return row.text;
  }
  return {};
}

TEST(SiteImport, RandomStationsOfAClosedRoomOnAnEndlessPlaneAreInsideWithARow) {
  const ImportedSite site = import_room({.num_random = 3, .clearance_m = 0.7});
  for (const Station& station : site.route->stations)
    EXPECT_LE(station.T_route_body.position().cwiseAbs().maxCoeff(), 1.85);
  EXPECT_LE(site.T_site_start.position().cwiseAbs().maxCoeff(), 1.85);
  EXPECT_EQ(row_of(site, "region"),
            "inside of walls: the ground outside has no end, and 2 m of it around the site do not count as area");
  EXPECT_EQ(row_of(import_room({.num_random = 1, .start = Pose2{3.6, 0.0, 0.0}, .clearance_m = 0.7}), "region"), "");
}

TEST(SiteImport, AStartInsideOfASolidIsRefusedWithoutStationsAndAnotherOneHasARow) {
  EXPECT_THAT(
      [] {
        import_room({.start = Pose2{0.0, 2.6, 0.0}});
      },
      ThrowsMessage<InputError>(HasSubstr("/scene.xml: start (0.00, 2.60): inside of north")));
  EXPECT_THAT(row_of(import_room({.start = Pose2{0.0, 0.0, 0.0}}), "start"), HasSubstr("the site has no mission"));
}

TEST_F(PlanImport, APlanOfTooManySpecksIsRefusedBeforeTheSimulatorReadsIt) {
  OccupancyGrid specks({.resolution_m = 0.1, .width = 500, .height = 500}, 0);
  for (int row = 0; row < 500; row += 2) {
    for (int col = 0; col < 500; col += 2) specks.at({col, row}) = 100;
  }
  io::save_map(folder_ / "specks.yaml", specks);
  SiteImportOptions many = options();
  many.file = folder_ / "specks.yaml";
  EXPECT_THAT([&] { import_site(many); }, ThrowsMessage<InputError>(HasSubstr(
                                              "specks.yaml: the occupied cells form 62500 rectangles: at most 60000 "
                                              "are allowed")));
}

TEST_F(PlanImport, WrongInputsAreRefusedAndNothingIsWritten) {
  test::write_bytes(folder_ / "stations.csv", "name,x,y\npump,1.0,north\n");
  EXPECT_THAT([&] { import_site(options({.stations = folder_ / "stations.csv"})); },
              ThrowsMessage<InputError>(HasSubstr("stations.csv:2: y: north: must be a number")));
  EXPECT_THAT([&] { import_site(options({.stations = "a.csv", .num_random = 1})); },
              ThrowsMessage<InputError>(HasSubstr("--stations and --random-stations are mutually exclusive")));
  EXPECT_THAT([&] { import_site(options({.num_random = 1, .clearance_m = 1.6})); },
              ThrowsMessage<InputError>(HasSubstr("no free cell with a clearance of 1.6 m")));
  SiteImportOptions unknown = options();
  unknown.file = folder_ / "room.dwg";
  EXPECT_THAT([&] { import_site(unknown); },
              ThrowsMessage<InputError>(HasSubstr("room.dwg: extension of a site file")));
  io::save_map(folder_ / "empty.yaml", OccupancyGrid({.width = 5, .height = 5}, 0));
  SiteImportOptions empty = options();
  empty.file = folder_ / "empty.yaml";
  EXPECT_THAT([&] { import_site(empty); }, ThrowsMessage<InputError>(HasSubstr("the plan has no occupied cell")));
  test::write_bytes(folder_ / "taken/file", "");
  std::filesystem::create_directories(folder_ / "taken");
  test::write_bytes(folder_ / "taken/file", "");
  EXPECT_THAT([&] { write_site(import_site(options()), folder_ / "taken"); },
              ThrowsMessage<InputError>(HasSubstr("exists and is not an empty folder")));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "worlds"));
}

// Heights of 0, 1 and 2 m from west to east over 2 m, and a triangle above it.
TEST(WriteSite, HeightFieldsAndMeshesKeepTheirHeightsAndPlacesTo1Millimeter) {
  const test::TemporaryFolder folder;
  Grid<float> heights({.resolution_m = 1.0, .width = 3, .height = 2, .origin_m = {3.5, 4.5}});
  heights.values() = {0.0F, 1.0F, 2.0F, 0.0F, 1.0F, 2.0F};
  ImportedSite site{.name = "slope", .source = "test"};
  site.materials = {{.name = "grass"}};
  site.shapes.push_back({.name = "terrain",
                         .type = SiteShapeType::kHeightField,
                         .material = "grass",
                         .height_field = {.height_m = heights}});
  site.shapes.push_back({.name = "roof",
                         .type = SiteShapeType::kMesh,
                         .use = ShapeUse::kSeen,
                         .T_site_shape = to_pose3(Pose2{5.0, 5.0, 0.0}, 6.0),
                         .material = "grass",
                         .mesh = {.vertices_m = {{-1.0, -1.0, 0.0}, {1.0, -1.0, 0.0}, {0.0, 1.0, 0.0}},
                                  .normals = {},
                                  .triangles = {{0, 1, 2}}}});
  write_site(site, folder / "slope");
  const sim::ModelPtr model = sim::compile(*sim::load_spec(folder / "slope/slope.xml"), "slope");
  const sim::LidarScene scene(*model);
  const auto height_m = [&](double x, double y, double from_m) {
    const auto hit = scene.cast({x, y, from_m}, {0.0, 0.0, -1.0}, 20.0, sim::kRayEverything);
    return hit ? from_m - hit->distance_m : -1.0;
  };
  EXPECT_NEAR(height_m(4.1, 5.3, 5.0), 0.1, 1e-3);  // the first column of heights is at x = 4 m
  EXPECT_NEAR(height_m(5.9, 5.7, 5.0), 1.9, 1e-3);
  EXPECT_NEAR(height_m(5.0, 5.1, 9.0), 6.0, 1e-3);
  EXPECT_EQ(height_m(3.8, 5.5, 5.0), -1.0);
}

}  // namespace
}  // namespace patrol::importer::site_import_test
