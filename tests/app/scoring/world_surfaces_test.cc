#include "app/scoring/world_surfaces.h"

#include <string>

#include <gtest/gtest.h>

#include "app/scoring/localizability_map.h"
#include "app/scoring/mapping_lidar.h"

namespace patrol::app::world_surfaces_test {
namespace {

constexpr double kHeight_m = 0.7;

/// Scenario of the street; the robot has the sensor frames of the test alone, 0.7 m above the origin of its body.
struct Street {
  explicit Street(const std::string& frame)
      : scenario(load_scenario(PATROL_SOURCE_DIR "/worlds/street/scenarios/short.yaml")),
        files(load_scenario_files(scenario, PATROL_SOURCE_DIR)) {
    files.robot.T_body_sensor.clear();
    if (!frame.empty()) files.robot.T_body_sensor[frame].position.z() = kHeight_m;
  }
  Scenario scenario;
  ScenarioFiles files;
};

TEST(MappingLidar, IsThe2dLidarOtherwiseThe3dLidar) {
  RobotDescription robot;
  EXPECT_FALSE(mapping_lidar(robot));
  robot.T_body_sensor["lidar3d"] = {};
  EXPECT_EQ(std::string(mapping_lidar(robot).value().frame), "lidar3d");
  robot.T_body_sensor["lidar"] = {};
  EXPECT_EQ(std::string(mapping_lidar(robot).value().frame), "lidar");
}

TEST(WorldSurfaces, AreAtTheHeightOfThe3dLidarOfARobotWithout2dLidar) {
  const double body_m = world_surfaces(Street("").files, 0.2).lidar_height_m;
  EXPECT_DOUBLE_EQ(world_surfaces(Street("lidar3d").files, 0.2).lidar_height_m, body_m + kHeight_m);
  EXPECT_DOUBLE_EQ(world_surfaces(Street("lidar").files, 0.2).lidar_height_m, body_m + kHeight_m);
}

TEST(LocalizabilityMap, OfARobotWithout2dLidarIsThatOfThe3dLidar) {
  Street street("lidar3d");
  street.scenario.sensors.lidar3d.range_max_m = 20.0;
  const auto max_std_m = [&] {
    return map_localizability(street.scenario, street.files, 10.0, [](double) {}).positions.front().truth.max_std_m;
  };
  const double precise_m = max_std_m();
  street.scenario.sensors.lidar3d.range_noise_std_m *= 2.0;
  EXPECT_GT(max_std_m(), 1.5 * precise_m);
}

}  // namespace
}  // namespace patrol::app::world_surfaces_test
