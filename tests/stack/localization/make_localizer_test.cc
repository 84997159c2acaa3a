#include "stack/localization/make_localizer.h"

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "tests/stack/standing_quadruped.h"

namespace patrol::stack::make_localizer_test {
namespace {

/// Variances of the pose that is published in a small room, where a scan determines it to millimeters.
Eigen::Vector3d published_variances(const LocalizerStart& start, double map_std_m, double map_yaw_std_deg) {
  StackSettings settings;
  settings.registration.map_std_m = map_std_m;
  settings.registration.map_yaw_std_deg = map_yaw_std_deg;
  const auto localizer = make_localizer(settings, test::make_quadruped(), {}, start, 1);
  localizer->set_initial_pose({}, Eigen::Vector3d(1e-4, 1e-4, 1e-4).asDiagonal());
  const test::RoomWorld room = small_room();
  StackOutput output;
  PoseEstimate pose;
  for (int i = 0; i <= 20; ++i) {
    const Pose2 truth{0.05 * i, 0.0, 0.0};
    LevelScan scan = room.scan(truth, {});
    scan.stamp = from_seconds(0.1 * i);
    pose = localizer->update(scan, truth, output);
  }
  return pose.covariance.diagonal();
}

// A scan match is known to millimeters; the deformation of the map is that of the settings.
TEST(MakeLocalizer, PublishedCovarianceContainsTheDeformationOfTheMapWithAndWithoutAGivenMap) {
  for (const LocalizerStart& start : {LocalizerStart{}, LocalizerStart{.map = map_of_small_room()}}) {
    const Eigen::Vector3d of_matches = published_variances(start, 0.0, 0.0);
    const Eigen::Vector3d with_map = published_variances(start, 0.03, 0.15);
    EXPECT_GT(of_matches.minCoeff(), 0.0);
    const Eigen::Vector3d expected = Eigen::Vector3d(0.03, 0.03, to_rad(0.15)).cwiseAbs2();
    EXPECT_LT((with_map - of_matches - expected).cwiseQuotient(expected).cwiseAbs().maxCoeff(), 1e-9);
  }
}

}  // namespace
}  // namespace patrol::stack::make_localizer_test
