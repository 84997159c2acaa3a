#include "plan/perception/depth_obstacles.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "tests/support/depth_scene.h"

namespace patrol::plan::depth_points_test {
namespace {

using test::DepthScene;

constexpr double kBodyHeight_m = 0.15;
constexpr double kStdPerM = 0.02;

/// The tracked robot's: 0.375 m above the ground, looking down by 0.48 rad.
Pose3 body_camera() { return {{0.445, 0.0, 0.225}, quaternion_from_rpy(0.0, 0.48, 0.0)}; }

/// On level ground at the world's origin.
DepthPoints look(const DepthScene& scene, std::uint64_t tick = 0, double std_per_m = kStdPerM) {
  const Pose3 T_world_level{{0.0, 0.0, kBodyHeight_m}, Eigen::Quaterniond::Identity()};
  const RandomStream noise(11, "test/depth");
  const DepthImage image = test::with_noise(scene.look(T_world_level * body_camera()), std_per_m, noise, tick);
  return segment_obstacles({}, image, body_camera(), kBodyHeight_m);
}

TEST(DepthPoints, AWallOfTwentyCentimetresIsAnObstacleWhereItStands) {
  DepthScene scene;
  scene.add_box({1.4, -0.5, 0.0}, {1.6, 0.5, 0.2});
  const DepthPoints points = look(scene, 0, 0.0);
  ASSERT_GT(points.obstacles_m.size(), 100u);
  for (const Eigen::Vector2d& p : points.obstacles_m) {
    EXPECT_GT(p.x(), 1.39);
    EXPECT_LT(p.x(), 1.61);
    EXPECT_LT(std::abs(p.y()), 0.55);  // a pixel at the edge may show half of each
  }
}

TEST(DepthPoints, FlatGroundWithoutNoiseIsGroundAlone) {
  const DepthPoints points = look(DepthScene(), 0, 0.0);
  EXPECT_TRUE(points.obstacles_m.empty());
  EXPECT_GT(points.ground_m.size(), 1000u);
  for (const Eigen::Vector2d& p : points.ground_m) EXPECT_LE((p - Eigen::Vector2d(0.445, 0.0)).norm(), 1.3);
}

// Rubble: waves of 3 cm to each side with a length of 0.7 m, at most 0.27 steep.
TEST(DepthPoints, RubbleOfThreeCentimetresIsGround) {
  const DepthScene scene([](double x, double y) { return 0.03 * std::sin(9.0 * x) * std::cos(9.0 * y); });
  EXPECT_TRUE(look(scene, 0, 0.0).obstacles_m.empty());
}

// Its foot is 0.9 m ahead; then 15 degrees up. And the robot on the ramp: the camera's tilt is known, the ground is not
// level.
TEST(DepthPoints, ARampOfFifteenDegreesIsGroundFromItsFootOn) {
  const double slope = std::tan(15.0 * kDegree);
  EXPECT_TRUE(
      look(DepthScene([=](double x, double) { return std::max(0.0, slope * (x - 0.9)); }), 0, 0.0).obstacles_m.empty());

  const DepthScene ramp([=](double x, double) { return slope * x; });
  const Pose3 T_level_body{Eigen::Vector3d::Zero(), quaternion_from_rpy(0.0, -15.0 * kDegree, 0.0)};
  const Pose3 T_world_level{{0.0, 0.0, kBodyHeight_m / std::cos(15.0 * kDegree)}, Eigen::Quaterniond::Identity()};
  const DepthImage image = ramp.look(T_world_level * T_level_body * body_camera());
  EXPECT_TRUE(segment_obstacles({}, image, T_level_body * body_camera(), kBodyHeight_m).obstacles_m.empty());
}

TEST(DepthPoints, TheCrestOfARampIsGround) {
  const double slope = std::tan(15.0 * kDegree);
  EXPECT_TRUE(
      look(DepthScene([=](double x, double) { return std::min(0.0, slope * (1.0 - x)); }), 0, 0.0).obstacles_m.empty());
}

// Overhead: a duct 1.2 m above the ground.
TEST(DepthPoints, WhatHangsHighIsLeftToTheLidar) {
  DepthScene scene;
  scene.add_box({1.2, -1.0, 1.2}, {1.8, 1.0, 1.5});
  EXPECT_TRUE(look(scene, 0, 0.0).obstacles_m.empty());
}

TEST(DepthPoints, AnImageWithoutDepthsSaysNothing) {
  DepthImage image = DepthScene().look({{0.0, 0.0, 0.4}, quaternion_from_rpy(0.0, 0.5, 0.0)});
  std::fill(image.depth_mm.begin(), image.depth_mm.end(), std::uint16_t{0});
  const DepthPoints points = segment_obstacles({}, image, body_camera(), kBodyHeight_m);
  EXPECT_TRUE(points.obstacles_m.empty());
  EXPECT_TRUE(points.ground_m.empty());
}

// A thing of one pixel is noise.
TEST(DepthPoints, ASinglePixelIsFilteredAway) {
  DepthImage image =
      DepthScene().look(Pose3{{0.0, 0.0, kBodyHeight_m}, Eigen::Quaterniond::Identity()} * body_camera());
  image.depth_mm[40 * 80 + 40] = 400;
  EXPECT_TRUE(segment_obstacles({}, image, body_camera(), kBodyHeight_m).obstacles_m.empty());
}

}  // namespace
}  // namespace patrol::plan::depth_points_test
