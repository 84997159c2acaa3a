#include "app/check/blocked_beams.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_file.h"

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
  EXPECT_THAT(warnings_of(lidars), IsEmpty());
}

TEST(BlockedBeams, ALidarInsideTheChassisIsReportedWithTheLinkThatEnclosesIt) {
  const std::vector<BlockedBeams> lidars = blocked({"mounts=[{frame: lidar, z_m: 0.05}]"});
  ASSERT_EQ(lidars.size(), 1U);
  EXPECT_EQ(lidars[0].ratio, 1.0);
  EXPECT_THAT(lidars[0].links, ElementsAre("base_link"));
  EXPECT_THAT(warnings_of(lidars),
              ElementsAre("all beams of lidar hit the robot itself: its frame is enclosed in base_link"));
}

TEST(BlockedBeams, TheWarningHasThePercentageAndTheLinksAndBeginsAbove5Percent) {
  EXPECT_THAT(warnings_of({{"lidar", 0.05, {"mast"}}, {"lidar_rear", 0.12, {"mast", "left_wheel"}}}),
              ElementsAre("12 % of the beams of lidar_rear hit the robot itself: mast, left_wheel"));
}

}  // namespace
}  // namespace patrol::app::blocked_beams_test
