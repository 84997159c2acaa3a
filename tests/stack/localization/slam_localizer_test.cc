#include "stack/localization/slam_localizer.h"

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "stack/localization/make_localizer.h"
#include "tests/stack/standing_quadruped.h"

namespace patrol::stack::slam_localizer_test {
namespace {

// The match of a scan in a small room is known to millimeters; the map may still be bent by what the settings say.
TEST(SlamLocalizer, ThePublishedCovarianceContainsTheDeformationOfTheMap) {
  StackSettings settings;
  const auto variances = [&](double map_std_m, double map_yaw_std_deg) {
    settings.registration.map_std_m = map_std_m;
    settings.registration.map_yaw_std_deg = map_yaw_std_deg;
    const auto localizer = make_localizer(settings, test::make_quadruped(), {}, {}, 1);
    const test::RoomWorld room = small_room();
    StackOutput output;
    PoseEstimate pose;
    for (int i = 0; i <= 20; ++i) {
      const Pose2 truth{0.05 * i, 0.0, 0.0};
      LevelScan scan = room.scan(truth, {});
      scan.stamp = from_seconds(0.1 * i);
      pose = localizer->update(scan, truth, output);
    }
    return Eigen::Vector3d(pose.covariance.diagonal());
  };
  const Eigen::Vector3d of_matches = variances(0.0, 0.0), with_map = variances(0.03, 0.15);
  EXPECT_GT(of_matches.minCoeff(), 0.0);
  const Eigen::Vector3d expected = Eigen::Vector3d(0.03, 0.03, to_rad(0.15)).cwiseAbs2();
  EXPECT_LT((with_map - of_matches - expected).cwiseQuotient(expected).cwiseAbs().maxCoeff(), 1e-9);
}

}  // namespace
}  // namespace patrol::stack::slam_localizer_test
