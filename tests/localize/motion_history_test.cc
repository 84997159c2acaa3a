#include "localize/motion_history.h"

#include <gtest/gtest.h>

namespace patrol::localize::motion_history_test {
namespace {

using std::chrono::milliseconds;

TrunkMotion at_x(double x_m) {
  TrunkMotion motion;
  motion.T_odom_body.position.x() = x_m;
  motion.v_body.x() = 10.0 * x_m;
  return motion;
}

TEST(MotionHistory, EmptyHasNoMotion) {
  const MotionHistory history(4);
  EXPECT_FALSE(history.pose_at(Time{0}));
  EXPECT_FALSE(history.motion_at(Time{0}));
}

TEST(MotionHistory, AQuarterOfTheTimeIsAQuarterOfTheDistance) {
  MotionHistory history(4);
  history.push(milliseconds(0), at_x(1.0));
  history.push(milliseconds(4), at_x(2.0));
  EXPECT_DOUBLE_EQ(history.pose_at(milliseconds(1))->position.x(), 1.25);
  EXPECT_DOUBLE_EQ(history.motion_at(milliseconds(1))->v_body.x(), 12.5);
  EXPECT_DOUBLE_EQ(history.pose_at(milliseconds(4))->position.x(), 2.0);
  EXPECT_FALSE(history.pose_at(milliseconds(5)));
}

TEST(MotionHistory, RingOfFourDropsTheFirstOfFive) {
  MotionHistory history(4);
  for (int i = 0; i < 5; ++i) history.push(milliseconds(10 * i), at_x(i));
  EXPECT_EQ(history.oldest(), milliseconds(10));
  EXPECT_FALSE(history.pose_at(milliseconds(9)));
  for (int i = 10; i <= 40; ++i) EXPECT_NEAR(history.pose_at(milliseconds(i))->position.x(), 0.1 * i, 1e-12);
}

TEST(MotionHistory, SameStampReplacesTheNewest) {
  MotionHistory history(4);
  history.push(milliseconds(0), at_x(1.0));
  history.push(milliseconds(4), at_x(2.0));
  history.push(milliseconds(4), at_x(3.0));
  EXPECT_DOUBLE_EQ(history.pose_at(milliseconds(2))->position.x(), 2.0);
}

}  // namespace
}  // namespace patrol::localize::motion_history_test
