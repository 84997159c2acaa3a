#include "io/logs/transform_buffer.h"

#include <gtest/gtest.h>

#include "tests/io/log_messages.h"
#include "tests/support/pose_near.h"

namespace patrol::io::frame_tree_test {
namespace {

using namespace std::chrono_literals;
using test::Pose3Near;

constexpr double kExactTol = 1e-12;

FrameTransform placed(const std::string& parent, const std::string& child, double x, Time stamp = {},
                      double yaw = 0.0) {
  return test::placed(parent, child, {{x, 0.0, 0.0}, quaternion_from_yaw(yaw)}, stamp);
}

TEST(TransformBuffer, AnUnknownFrameRelativeToItselfIsTheIdentity) {
  EXPECT_THAT(*TransformBuffer().find("a", "a", 5s), Pose3Near(Pose3{}, 0.0, 0.0));
}

TEST(TransformBuffer, ChainsUpwardsAndBack) {
  TransformBuffer tree;
  tree.add_static(placed("base_link", "plate", 1.0));
  tree.add_static(placed("plate", "lidar", 0.25));
  EXPECT_THAT(*tree.find("base_link", "lidar", 0s),
              Pose3Near((Pose3{{1.25, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}}), kExactTol, kExactTol));
  EXPECT_THAT(*tree.find("lidar", "base_link", 0s),
              Pose3Near((Pose3{{-1.25, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}}), kExactTol, kExactTol));
}

TEST(TransformBuffer, JoinsBranchesAtTheirCommonFrame) {
  TransformBuffer tree;
  tree.add_static(placed("base_link", "lidar", 1.0));
  tree.add_static(placed("base_link", "imu", -2.0));
  EXPECT_THAT(*tree.find("imu", "lidar", 0s),
              Pose3Near((Pose3{{3.0, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}}), kExactTol, kExactTol));
}

TEST(TransformBuffer, MovingFramesAreInterpolatedWithinTheirTimeOnly) {
  TransformBuffer tree;
  tree.add(placed("odom", "base_link", 1.0, 1s, 0.0));
  tree.add(placed("odom", "base_link", 3.0, 2s, 0.4));
  EXPECT_THAT(*tree.find("odom", "base_link", 1500ms),
              Pose3Near((Pose3{{2.0, 0.0, 0.0}, quaternion_from_yaw(0.2)}), kExactTol, 1e-7));
  EXPECT_FALSE(tree.find("odom", "base_link", 999ms));
  EXPECT_FALSE(tree.find("odom", "base_link", 2001ms));
}

TEST(TransformBuffer, FramesAboveTheCommonFrameAreNotRequired) {
  TransformBuffer tree;
  tree.add(placed("map", "odom", 7.0, 0s));
  tree.add(placed("odom", "base_link", 1.0, 1s));
  tree.add(placed("odom", "base_link", 1.0, 2s));
  EXPECT_TRUE(tree.find("odom", "base_link", 1500ms));
  EXPECT_FALSE(tree.find("map", "base_link", 1500ms));
}

TEST(TransformBuffer, UnknownFramesAreNotFoundAndLoopsEnd) {
  TransformBuffer tree;
  tree.add_static(placed("a", "b", 1.0));
  tree.add_static(placed("b", "a", 1.0));
  EXPECT_FALSE(tree.find("c", "a", 0s));
  EXPECT_FALSE(tree.find("base_link", "lidar", 0s));
}

TEST(TransformBuffer, StampsThatDoNotGrowAreDropped) {
  TransformBuffer tree;
  tree.add(placed("odom", "base_link", 1.0, 2s));
  tree.add(placed("odom", "base_link", 5.0, 2s));
  tree.add(placed("odom", "base_link", 6.0, 1s));
  EXPECT_THAT(*tree.find("odom", "base_link", 2s),
              Pose3Near((Pose3{{1.0, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}}), kExactTol, kExactTol));
  EXPECT_FALSE(tree.find("odom", "base_link", 1s));
}

TEST(TransformBuffer, RemembersTenSeconds) {
  TransformBuffer tree;
  for (int i = 0; i <= 100; ++i) tree.add(placed("odom", "base_link", i, i * 1s));
  EXPECT_TRUE(tree.find("odom", "base_link", 90s));
  EXPECT_FALSE(tree.find("odom", "base_link", 89s));
}

TEST(TransformBuffer, BuffersAtMostTwoThousandPoses) {
  TransformBuffer tree;
  for (int i = 0; i < 3000; ++i) tree.add(placed("odom", "base_link", i, i * 1ms));
  EXPECT_TRUE(tree.find("odom", "base_link", 1000ms));
  EXPECT_FALSE(tree.find("odom", "base_link", 999ms));
}

TEST(TransformBuffer, ANewParentMakesTheOldOneForgotten) {
  TransformBuffer tree;
  tree.add_static(placed("a", "lidar", 1.0));
  tree.add_static(placed("b", "lidar", 2.0));
  EXPECT_FALSE(tree.find("a", "lidar", 0s));
  EXPECT_TRUE(tree.find("b", "lidar", 0s));
}

TEST(TransformBuffer, TheLeadingSlashOfOldNamesDoesNotCount) {
  TransformBuffer tree;
  tree.add_static(placed("/base_link", "/lidar", 1.0));
  EXPECT_TRUE(tree.find("base_link", "lidar", 0s));
}

TEST(TransformBuffer, NotesAThousandFrames) {
  TransformBuffer tree;
  for (int i = 0; i < 2000; ++i) tree.add_static(placed("base_link", "f" + std::to_string(i), 1.0));
  EXPECT_TRUE(tree.find("base_link", "f999", 0s));
  EXPECT_FALSE(tree.find("base_link", "f1000", 0s));
}

}  // namespace
}  // namespace patrol::io::frame_tree_test
