#include "app/record/run_record.h"

#include <gtest/gtest.h>

namespace patrol::app::run_record_test {
namespace {

/// Run that starts at (2, 1) in world, the origin of map, and is registered twice.
RunRecord registered_run() {
  RunRecord record;
  record.T_map_body = {{from_seconds(1.0), to_pose3(Pose2{})}};
  record.T_world_body = {{from_seconds(1.0), to_pose3(Pose2{2.0, 1.0, 0.0})}};
  for (const double y_m : {1.1, 1.2}) {
    SiteRegistration registration;
    registration.stamp = from_seconds(y_m);
    registration.T_site_map = {2.0, y_m, 0.01};
    record.registrations.push_back(registration);
  }
  return record;
}

TEST(PoseOfMap, IsThatOfAGivenMapElseOfTheLastRegistrationElseOfTheStart) {
  RunRecord record = registered_run();
  EXPECT_EQ(pose_of_map(record, Pose2{5.0, 6.0, 0.3}).vector(), Eigen::Vector3d(5.0, 6.0, 0.3));
  EXPECT_EQ(pose_of_map(record, std::nullopt).vector(), Eigen::Vector3d(2.0, 1.2, 0.01));
  record.registrations.clear();
  EXPECT_EQ(pose_of_map(record, std::nullopt).vector(), Eigen::Vector3d(2.0, 1.0, 0.0));
}

TEST(PoseOfMap, IsTheFirstTruePoseOfAStackThatPublishesNoPose) {
  RunRecord record;
  record.T_world_body = {{Time{}, to_pose3({4.0, -1.0, 0.5}, 0.3)}, {from_seconds(1.0), to_pose3({5.0, -1.0, 0.5})}};
  const Pose2 pose = pose_of_map(record, std::nullopt);
  EXPECT_NEAR((pose.vector() - Eigen::Vector3d(4.0, -1.0, 0.5)).norm(), 0.0, 1e-12);
}

}  // namespace
}  // namespace patrol::app::run_record_test
