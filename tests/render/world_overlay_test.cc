#include "render/world_overlay.h"

#include <gtest/gtest.h>

#include "render/scene/scene_painter.h"
#include "tests/render/small_scene.h"

namespace patrol::render::world_ink_test {
namespace {

constexpr int kWidth = 320, kHeight = 180;
constexpr Color kPink{255, 0, 160};

/// A wall at x = 4, 2 m wide and 1 m high, on a plane; one looks along x from the origin.
class WorldInkTest : public ::testing::Test {
 protected:
  void SetUp() override { painter.draw(view, frame, depth); }

  Color color_at(const Eigen::Vector3d& point) const {
    const Eigen::Vector2d pixel = Projector(view, kWidth, kHeight).project(point)->pixel;
    return frame.at(static_cast<int>(pixel.x()), static_cast<int>(pixel.y()));
  }

  sim::ModelPtr model = small_scene(R"(<geom type="plane" size="50 50 1" rgba="0.3 0.6 0.3 1"/>
                                       <geom type="box" size="0.1 1 0.5" pos="4.1 0 0.5" rgba="0.5 0.5 0.5 1"/>)");
  View view = look_at({0.0, 0.0, 1.0}, {4.0, 0.0, 0.8});
  SceneRenderer painter{*model, kWidth, kHeight};
  Frame frame;
  std::vector<float> depth;
};

TEST_F(WorldInkTest, ALineShowsWhereItLies) {
  const std::vector<Eigen::Vector3d> line = {{2.0, -1.0, 0.01}, {2.0, 1.0, 0.01}};
  WorldOverlay(frame, depth, Projector(view, kWidth, kHeight)).polyline(line, 0.05, {kPink, 1.0});
  for (double y = -0.9; y < 0.95; y += 0.1) EXPECT_EQ(color_at({2.0, y, 0.01}), kPink);
  EXPECT_NE(color_at({2.0, 1.2, 0.01}), kPink);
}

TEST_F(WorldInkTest, ALineBehindAWallIsHiddenAndComesOutBesideIt) {
  const std::vector<Eigen::Vector3d> line = {{6.0, -3.0, 0.3}, {6.0, 3.0, 0.3}};
  WorldOverlay(frame, depth, Projector(view, kWidth, kHeight)).polyline(line, 0.1, {kPink, 1.0});
  EXPECT_NE(color_at({6.0, 0.0, 0.3}), kPink);
  EXPECT_EQ(color_at({6.0, 2.5, 0.3}), kPink);
  EXPECT_EQ(color_at({6.0, -2.5, 0.3}), kPink);
}

TEST_F(WorldInkTest, DotsOnASurfaceAreSeen) {
  const std::vector<Eigen::Vector3d> dots = {{4.0, 0.0, 0.5}, {4.0, 0.5, 0.7}};
  WorldOverlay(frame, depth, Projector(view, kWidth, kHeight)).dots(dots, 0.03, {kPink, 1.0});
  for (const Eigen::Vector3d& dot : dots) EXPECT_EQ(color_at(dot), kPink);
}

TEST_F(WorldInkTest, WhatRunsPastTheEyeIsCutAtTheNearPlane) {
  const std::vector<Eigen::Vector3d> line = {{-5.0, 0.3, 0.5}, {3.0, 0.3, 0.5}};
  WorldOverlay(frame, depth, Projector(view, kWidth, kHeight)).polyline(line, 0.05, {kPink, 1.0});
  EXPECT_EQ(color_at({2.5, 0.3, 0.5}), kPink);
}

TEST_F(WorldInkTest, AThinInkDoesNotAddUpWhereALineMeetsItself) {
  const std::vector<Eigen::Vector3d> there_and_back = {{2.0, -1.0, 0.01}, {2.0, 1.0, 0.01}, {2.0, -1.0, 0.01}};
  const Color ground = color_at({2.0, 0.0, 0.01});
  WorldOverlay(frame, depth, Projector(view, kWidth, kHeight)).polyline(there_and_back, 0.05, {kPink, 0.5});
  EXPECT_EQ(color_at({2.0, 0.0, 0.01}), blend(ground, kPink, 0.5));
}

}  // namespace
}  // namespace patrol::render::world_ink_test
