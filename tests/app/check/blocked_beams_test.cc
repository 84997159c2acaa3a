#include "app/check/blocked_beams.h"

#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/files/atomic_file.h"
#include "tests/support/temporary_file.h"
#include "tests/support/wheeled_urdf.h"

namespace patrol::app::blocked_beams_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<BlockedBeams> blocked(const std::vector<std::string>& overrides) {
  const test::TemporaryFolder folder;
  return blocked_beams(load_check_robot("wheeled", overrides, {}, PATROL_SOURCE_DIR), folder.path());
}

TEST(BlockedBeams, TheLidarOfTheWheeledRobotSeesPastTheRobot) {
  const std::vector<BlockedBeams> lidars = blocked({});
  ASSERT_EQ(lidars.size(), 1U);
  EXPECT_LT(lidars[0].ratio, 0.05);
  EXPECT_THAT(warnings_of(lidars, {}), IsEmpty());
}

TEST(BlockedBeams, ALidarInsideTheChassisIsReportedWithTheLinkThatEnclosesIt) {
  const std::vector<BlockedBeams> lidars = blocked({"mounts=[{frame: lidar, z_m: 0.05}]"});
  ASSERT_EQ(lidars.size(), 1U);
  EXPECT_EQ(lidars[0].ratio, 1.0);
  EXPECT_THAT(lidars[0].links, ElementsAre("base_link"));
  EXPECT_THAT(warnings_of(lidars, {}),
              ElementsAre("all beams of lidar hit the robot itself: its frame is enclosed in base_link"));
}

/// Blocked beams of a differential robot with more links and the mount of a lidar, "z_m: 1".
std::vector<BlockedBeams> of_rover(const std::string& links, const std::string& mount,
                                   std::vector<std::string> overrides) {
  std::string urdf = test::differential_urdf().text();
  urdf.insert(urdf.find("</robot>"), links);
  const test::TemporaryFolder root;
  const std::filesystem::path model = root / "models/rover";
  std::filesystem::create_directories(model);
  io::save_text(model / "rover.urdf", urdf);
  overrides.push_back(fmt::format("mounts=[{{frame: lidar, {}}}]", mount));
  return blocked_beams(load_check_robot("rover", overrides, {}, root.path()), root.path());
}

/// The same with a lidar on a mast; `height_m`: of the origin of the beams above the top of the mast.
std::vector<BlockedBeams> on_mast(double height_m, const std::vector<std::string>& overrides) {
  const std::string mast = R"(<link name="mast"><visual><origin xyz="0 0 0.5"/><geometry>
      <cylinder radius="0.03" length="1"/></geometry></visual></link><joint name="mast_joint" type="fixed">
      <parent link="base_link"/><child link="mast"/></joint>)";
  return of_rover(mast, fmt::format("z_m: {}", 1.0 + height_m), overrides);
}

// 1 mm above the mast, no beam hits it; 3 mm lower, all beams do.
TEST(BlockedBeams, ALidarOnTopOfAMastIsReportedBecauseOfTheToleranceOfItsMount) {
  const std::vector<BlockedBeams> lidars = on_mast(0.001, {});
  ASSERT_EQ(lidars.size(), 1U);
  EXPECT_EQ(lidars[0].ratio, 0.0);
  EXPECT_EQ(lidars[0].max_ratio, 1.0);
  EXPECT_THAT(warnings_of(lidars, {}),
              ElementsAre("100 % of the beams of lidar hit the robot itself with a mount within the tolerance "
                          "as_built.mounting, 0 % with the nominal mount: mast: raise the frame by mounts"));
  EXPECT_THAT(warnings_of(on_mast(0.001, {"as_built.enabled=false"}), {}), IsEmpty());
  EXPECT_THAT(warnings_of(on_mast(0.02, {}), {}), IsEmpty());
}

TEST(BlockedBeams, TheLidarsOfTheRobotsOfPatrolAreClearOfThemWithEveryMount) {
  for (const char* name : {"wheeled", "cart", "tracked", "quadruped"}) {
    const test::TemporaryFolder folder;
    const CheckRobot robot = load_check_robot(name, {}, {}, PATROL_SOURCE_DIR);
    EXPECT_THAT(warnings_of(blocked_beams(robot, folder.path()), robot.scan_leveling), IsEmpty()) << name;
  }
}

TEST(BlockedBeams, TheWarningHasThePercentageAndTheLinksAndBeginsAbove5Percent) {
  EXPECT_THAT(warnings_of({{"lidar", 0.05, {"mast"}}, {"lidar_rear", 0.12, {"mast", "left_wheel"}}}, {}),
              ElementsAre("12 % of the beams of lidar_rear hit the robot itself: mast, left_wheel"));
}

// A pole of 4 cm in front of the lidar: tangent beams hit it 0.394 m from the middle of the robot.
TEST(BlockedBeams, OfAPoleOutsideTheSelfFilterNameTheRadiusThatIncludesIt) {
  const std::string pole =
      "<link name='pole'><visual><geometry><cylinder radius='0.02' length='1'/></geometry></visual>"
      "</link><joint name='pole_joint' type='fixed'><parent link='base_link'/><child link='pole'/>"
      "<origin xyz='0.4 0 0.5'/></joint>";
  const std::vector<BlockedBeams> lidars = of_rover(pole, "x_m: 0.3, z_m: 0.6", {"as_built.enabled=false"});
  ASSERT_EQ(lidars.size(), 1U);
  EXPECT_NEAR(lidars[0].max_distance_m, 0.394, 0.002);
  EXPECT_THAT(warnings_of(lidars, {}),
              ElementsAre("6 % of the beams of lidar hit the robot itself: pole; these hits are up to 0.39 m from the "
                          "middle of the robot, and block its path beyond stack.scan_leveling.self_filter_radius_m, "
                          "0.32 m: set it to 0.44 m"));
  EXPECT_THAT(warnings_of(lidars, {.self_filter_radius_m = 0.44}),
              ElementsAre("6 % of the beams of lidar hit the robot itself: pole"));
}

}  // namespace
}  // namespace patrol::app::blocked_beams_test
