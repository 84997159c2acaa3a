#include "stack/localization/known_map_localizer.h"

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "stack/localization/make_localizer.h"
#include "tests/stack/standing_quadruped.h"

namespace patrol::stack::known_map_localizer_test {
namespace {

/// A room of 8 m by 6 m in cells of 5 cm; free inside.
OccupancyGrid room_map() {
  OccupancyGrid map({.resolution_m = 0.05, .width = 164, .height = 124, .origin_m = {-4.1, -3.1}}, kUnknown);
  for (int row = 2; row < 122; ++row)
    for (int col = 2; col < 162; ++col)
      map.at({col, row}) = row == 2 || row == 121 || col == 2 || col == 161 ? kOccupied : kFree;
  return map;
}

TEST(KnownMapLocalizer, ThePublishedCovarianceContainsTheDeformationOfTheMap) {
  const auto variances = [](double map_std_m, double map_yaw_std_deg) {
    StackSettings settings;
    settings.registration.map_std_m = map_std_m;
    settings.registration.map_yaw_std_deg = map_yaw_std_deg;
    const auto localizer = make_localizer(settings, test::make_quadruped(), {}, {.map = room_map()}, 1);
    localizer->set_initial_pose({}, Eigen::Vector3d(1e-4, 1e-4, 1e-4).asDiagonal());
    test::RoomWorld room;
    room.add_box(-4.0, -3.0, 4.0, 3.0);
    StackOutput output;
    PoseEstimate pose;
    for (int i = 0; i <= 10; ++i) {
      const Pose2 truth{0.05 * i, 0.0, 0.0};
      LevelScan scan = room.scan(truth, {});
      scan.stamp = from_seconds(0.1 * i);
      pose = localizer->update(scan, truth, output);
    }
    return Eigen::Vector3d(pose.covariance.diagonal());
  };
  const Eigen::Vector3d of_matches = variances(0.0, 0.0), with_map = variances(0.05, 0.2);
  EXPECT_GT(of_matches.minCoeff(), 0.0);
  const Eigen::Vector3d expected = Eigen::Vector3d(0.05, 0.05, to_rad(0.2)).cwiseAbs2();
  EXPECT_LT((with_map - of_matches - expected).cwiseQuotient(expected).cwiseAbs().maxCoeff(), 1e-9);
}

}  // namespace
}  // namespace patrol::stack::known_map_localizer_test
