#include "app/check/scan_reach.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "importer/robot/scan_band.h"

namespace patrol::app::scan_reach_test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

CheckRobot wheeled(const std::vector<std::string>& overrides) {
  return load_check_robot("wheeled", overrides, {}, PATROL_SOURCE_DIR);
}

// (height of the lidar - 0.15 m) / 0.008
TEST(ScanReach, HitsOfALevelBeamCountUntilTheLowerEdgeOfTheBandReachesIt) {
  const CheckRobot robot = wheeled({});
  const double height_m = robot.description.body_height_m() + robot.description.T_body("lidar").position.z();
  EXPECT_NEAR(scan_reach_m(robot), (height_m - 0.15) / 0.008, 1e-9);
  EXPECT_THAT(scan_reach_warnings(robot), IsEmpty());
}

TEST(ScanReach, ALidarNearTheGroundIsReportedWithItsHeightUntilTheMinimumHeightIsLowered) {
  const double height_m = wheeled({}).description.body_height_m();
  const std::string mount = fmt::format("mounts=[{{frame: lidar, z_m: {}}}]", 0.07 - height_m);
  EXPECT_EQ(scan_reach_m(wheeled({mount})), 0.0);
  EXPECT_THAT(scan_reach_warnings(wheeled({mount})),
              ElementsAre(AllOf(HasSubstr("lidar is 0.07 m above the ground"), HasSubstr("farther than 0.0 m"))));
  EXPECT_THAT(scan_reach_warnings(wheeled({mount, "stack.scan_leveling.min_height_m=0.03"})), IsEmpty());
  const std::string higher = fmt::format("mounts=[{{frame: lidar, z_m: {}}}]", 0.17 - height_m);
  EXPECT_THAT(scan_reach_warnings(wheeled({higher})), ElementsAre(HasSubstr("farther than 2.5 m")));
}

TEST(ScanReach, WithoutALidarThereIsNoWarning) {
  EXPECT_THAT(scan_reach_warnings(wheeled({"sensors.lidar.enabled=false"})), IsEmpty());
}

TEST(ScanReach, AScanPlaneThatIsNotHorizontalIsReportedAndALidarUpsideDownIsNot) {
  EXPECT_THAT(scan_plane_warnings(wheeled({})), IsEmpty());
  EXPECT_THAT(scan_plane_warnings(wheeled({"mounts=[{frame: lidar, z_m: 0.6, pitch_deg: 90.0}]"})),
              ElementsAre("the scan plane of lidar is tilted by 90 degrees: mapping and navigation need a horizontal "
                          "one"));
  EXPECT_THAT(scan_plane_warnings(wheeled({"mounts=[{frame: lidar, z_m: 0.6, roll_deg: 180.0}]"})), IsEmpty());
}

TEST(ScanReach, TheDefaultsOfTheImporterAreThoseOfTheStack) {
  const localize::ScanLevelerSettings defaults;
  EXPECT_EQ(importer::kDefaultMinHitHeight_m, defaults.min_height_m);
  EXPECT_EQ(importer::kDefaultSelfFilterRadius_m, defaults.self_filter_radius_m);
  EXPECT_EQ(importer::kDefaultTiltMargin_rad, defaults.tilt_margin_rad);
}

}  // namespace
}  // namespace patrol::app::scan_reach_test
