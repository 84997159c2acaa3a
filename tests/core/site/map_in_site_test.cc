#include "core/site/map_in_site.h"

#include <gtest/gtest.h>

#include "tests/support/pose_near.h"

namespace patrol::map_in_site_test {
namespace {

using namespace std::chrono_literals;

constexpr Pose2 kStart{11.0, 8.0, 1.5}, kFirst{11.1, 8.0, 1.5}, kSecond{11.1, 8.2, 1.5};

MapInSite registered_twice() {
  return {kStart, {{.stamp = 2s, .T_site_map = kFirst}, {.stamp = 5s, .T_site_map = kSecond}}};
}

TEST(MapInSite, IsTheSurveyedStartBeforeTheFirstRegistrationAndTheNewestAfterIt) {
  const MapInSite map = registered_twice();
  EXPECT_THAT(map.at(1999ms).T_site_map, test::Pose2Near(kStart, 1e-12, 1e-12));
  EXPECT_THAT(map.at(2s).T_site_map, test::Pose2Near(kFirst, 1e-12, 1e-12));
  EXPECT_THAT(map.at(4999ms).T_site_map, test::Pose2Near(kFirst, 1e-12, 1e-12));
  EXPECT_THAT(map.at(60s).T_site_map, test::Pose2Near(kSecond, 1e-12, 1e-12));
  EXPECT_THAT(map.last().T_site_map, test::Pose2Near(kSecond, 1e-12, 1e-12));
  EXPECT_EQ(map.num_registrations(), 2U);
}

TEST(MapInSite, WithoutRegistrationsIsFixed) {
  EXPECT_THAT(MapInSite(kStart).last().T_site_map, test::Pose2Near(kStart, 1e-12, 1e-12));
  EXPECT_THAT(MapInSite().at(1s).T_site_map, test::Pose2Near(Pose2{}, 1e-12, 1e-12));
}

TEST(MapInSite, PlacesEachPoseByTheRegistrationOfItsTime) {
  const Pose3 ahead = to_pose3(Pose2{1.0, 0.0, 0.0});
  const Trajectory path = registered_twice().place({{1s, ahead}, {3s, ahead}});
  ASSERT_EQ(path.size(), 2U);
  EXPECT_THAT(to_pose2(path[0].pose), test::Pose2Near(kStart * Pose2{1.0, 0.0, 0.0}, 1e-12, 1e-12));
  EXPECT_THAT(to_pose2(path[1].pose), test::Pose2Near(kFirst * Pose2{1.0, 0.0, 0.0}, 1e-12, 1e-12));
}

}  // namespace
}  // namespace patrol::map_in_site_test
