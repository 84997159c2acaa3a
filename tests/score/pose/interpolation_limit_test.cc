#include "score/pose/interpolation_limit.h"

#include <gtest/gtest.h>

namespace patrol::score::interpolation_limit_test {
namespace {

using namespace std::chrono_literals;

Trajectory every(Time step, int count) {
  Trajectory trajectory;
  for (int i = 0; i < count; ++i) trajectory.push_back({i * step, to_pose3({1.0 * i, 0.0, 0.0})});
  return trajectory;
}

TEST(InterpolationLimit, IsThreeMedianStepsAndAtLeastASecond) {
  EXPECT_EQ(max_interpolated_step(every(10ms, 50)), Time(1s));
  EXPECT_EQ(max_interpolated_step(every(2s, 5)), Time(6s));
  EXPECT_EQ(max_interpolated_step({}), Time(1s));
}

TEST(PoseOutsideHoles, IsInterpolatedInShortStepsOnly) {
  Trajectory trajectory = every(1s, 4);
  trajectory.push_back({10s, to_pose3({4.0, 0.0, 0.0})});
  EXPECT_EQ(pose_outside_holes(trajectory, 500ms, 1s)->position.x(), 0.5);
  EXPECT_EQ(pose_outside_holes(trajectory, 3s, 1s)->position.x(), 3.0);
  EXPECT_FALSE(pose_outside_holes(trajectory, 5s, 1s));
  EXPECT_EQ(pose_outside_holes(trajectory, 10s, 1s)->position.x(), 4.0);
  EXPECT_FALSE(pose_outside_holes(trajectory, 11s, 1s));
}

}  // namespace
}  // namespace patrol::score::interpolation_limit_test
