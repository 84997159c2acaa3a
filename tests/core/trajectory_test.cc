#include "core/trajectory.h"

#include <gtest/gtest.h>

#include "tests/support/pose_near.h"

namespace patrol::trajectory_test {
namespace {

using namespace std::chrono_literals;
using test::Pose3Near;

StampedPose at(Time stamp, double x, double y, double z, double yaw = 0.0) {
  return {stamp, {{x, y, z}, quaternion_from_yaw(yaw)}};
}

const Trajectory kWalk = {at(1s, 0, 0, 0), at(3s, 4, 0, 1, 1.0), at(4s, 4, 3, 9, 1.0)};

TEST(PoseAt, GivesTheKnotsThemselves) {
  for (const StampedPose& knot : kWalk) EXPECT_THAT(*pose_at(kWalk, knot.stamp), Pose3Near(knot.pose, 0.0, 1e-7));
}

TEST(PoseAt, AQuarterOfTheTimeIsAQuarterOfTheWayAndTurn) {
  EXPECT_THAT(*pose_at(kWalk, 1500ms), Pose3Near(at(1s, 1.0, 0.0, 0.25, 0.25).pose, 1e-12, 1e-7));
}

TEST(PoseAt, KnowsNothingBeforeTheFirstAndAfterTheLast) {
  EXPECT_FALSE(pose_at(kWalk, 1s - 1ns));
  EXPECT_FALSE(pose_at(kWalk, 4s + 1ns));
  EXPECT_FALSE(pose_at({}, 1s));
  EXPECT_TRUE(pose_at({at(1s, 0, 0, 0)}, 1s));
}

TEST(PlanarLength, FourAndThreeAreSevenWhateverTheHeights) {
  EXPECT_DOUBLE_EQ(planar_length_m(kWalk), 7.0);
  EXPECT_DOUBLE_EQ(planar_length_m({}), 0.0);
  EXPECT_DOUBLE_EQ(planar_length_m({kWalk.front()}), 0.0);
}

}  // namespace
}  // namespace patrol::trajectory_test
