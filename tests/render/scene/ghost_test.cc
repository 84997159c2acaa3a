#include "render/scene/ghost.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "render/scene/scene_painter.h"
#include "tests/render/small_scene.h"

namespace patrol::render::ghost_test {
namespace {

constexpr int kWidth = 320, kHeight = 180;
const View kAbove = look_at({0.0, 0.0, 6.0}, {0.0, 0.0, 0.0});

class GhostTest : public ::testing::Test {
 protected:
  Frame draw(const Pose2& T_true_estimate) {
    painter.set_state(reference_state(*model));
    painter.set_estimate(T_true_estimate);
    Frame frame;
    std::vector<float> depth;
    painter.draw(kAbove, frame, depth);
    return frame;
  }
  static Color color_at(const Frame& frame, double x, double y) {
    const Eigen::Vector2d pixel = Projector(kAbove, kWidth, kHeight).project({x, y, 0.3})->pixel;
    return frame.at(static_cast<int>(pixel.x()), static_cast<int>(pixel.y()));
  }

  sim::ModelPtr model = small_scene(kRobotBeforeWall);
  SceneRenderer painter{*model, kWidth, kHeight};
};

TEST_F(GhostTest, StandsWhereTheRobotBelievesToBeAndOneSeesTheGroundThroughIt) {
  const Frame without = draw({}), with = draw({1.0, -1.0, 0.0});
  const Color ground = color_at(without, 1.0, -1.0), ghost = color_at(with, 1.0, -1.0);
  EXPECT_GT(ghost.r, ground.r + 40) << "orange on green";
  EXPECT_GT(ghost.g, 40) << "and not only orange";
  EXPECT_EQ(color_at(with, 0.0, 0.0), color_at(without, 0.0, 0.0)) << "the robot itself stays";
}

TEST_F(GhostTest, IsNotDrawnForAnErrorThatNobodyWouldSee) { EXPECT_EQ(draw({0.02, 0.01, 0.01}), draw({})); }

// The robot's box is 0.6 m long along x: turned by a right angle it is that long along y.
TEST_F(GhostTest, IsTurnedAsTheEstimateIs) {
  const Frame without = draw({}), straight = draw({1.5, 0.0, 0.0}), turned = draw({1.5, 0.0, 1.5708});
  EXPECT_EQ(color_at(straight, 1.5, 0.25), color_at(without, 1.5, 0.25));
  EXPECT_GT(color_at(turned, 1.5, 0.25).r, color_at(without, 1.5, 0.25).r + 40);
}

TEST(GhostOpacity, GrowsWithTheErrorAndStaysAtOne) {
  EXPECT_EQ(ghost_opacity({0.03, 0.0, 0.0}), 0.0);
  EXPECT_NEAR(ghost_opacity({0.0, 0.08, 0.0}), 0.5, 1e-9);
  EXPECT_EQ(ghost_opacity({5.0, 0.0, 0.0}), 1.0);
  EXPECT_GT(ghost_opacity({0.0, 0.0, -0.2}), 0.0) << "turned on the spot";
}

}  // namespace
}  // namespace patrol::render::ghost_test
