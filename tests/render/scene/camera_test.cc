#include "render/scene/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "render/scene/scene_painter.h"
#include "tests/render/small_scene.h"

namespace patrol::render::camera_test {
namespace {

TEST(Projector, PutsWhatIsStraightAheadInTheMiddle) {
  const Projector projector(look_at({1.0, 2.0, 3.0}, {5.0, 2.0, 1.0}), 640, 360);
  const auto projected = projector.project({5.0, 2.0, 1.0});
  ASSERT_TRUE(projected);
  EXPECT_NEAR(projected->pixel.x(), 320.0, 1e-9);
  EXPECT_NEAR(projected->pixel.y(), 180.0, 1e-9);
  EXPECT_NEAR(projected->distance_m, std::sqrt(20.0), 1e-9);
}

TEST(Projector, PutsTheEdgeOfTheFieldOfViewOnTheEdgeOfThePicture) {
  View view = look_at({0.0, 0.0, 0.0}, {1.0, 0.0, 0.0});
  view.field_of_view_rad = std::numbers::pi / 2.0;  // as high at 1 m as 2 m
  const Projector projector(view, 640, 360);
  EXPECT_NEAR(projector.project({1.0, 0.0, 1.0})->pixel.y(), 0.0, 1e-9);
  EXPECT_NEAR(projector.project({1.0, -0.5, 0.0})->pixel.x(), 320.0 + 0.5 * 180.0, 1e-9);  // y is to the left
}

TEST(Projector, SeesNothingBehind) {
  EXPECT_FALSE(Projector(look_at({0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}), 640, 360).project({-1.0, 0.0, 0.0}));
}

TEST(Projector, AgreesWithMuJoCoWithinAPixelAndOnDepthWithinAMillimetre) {
  const sim::ModelPtr model = small_scene(R"(<geom type="sphere" size="0.05" pos="4 0.7 1.1" rgba="1 0 0 1"/>)");
  const View view = look_at({0.0, -0.5, 1.6}, {4.0, 0.0, 0.9});
  SceneRenderer painter(*model, 640, 360);
  Frame frame;
  std::vector<float> depth;
  painter.draw(view, frame, depth);
  double sum_x = 0.0, sum_y = 0.0, nearest = 1e9;
  int count = 0;
  const Projector projector(view, 640, 360);
  for (int y = 0; y < 360; ++y) {
    for (int x = 0; x < 640; ++x) {
      if (frame.at(x, y).r < 2 * frame.at(x, y).b) continue;  // sky is blue
      sum_x += x + 0.5;
      sum_y += y + 0.5;
      nearest = std::min(nearest, projector.distance_m(depth[static_cast<std::size_t>(y * 640 + x)]));
      ++count;
    }
  }
  ASSERT_GT(count, 20);
  const auto expected = projector.project({4.0, 0.7, 1.1});
  EXPECT_NEAR(sum_x / count, expected->pixel.x(), 1.0);
  EXPECT_NEAR(sum_y / count, expected->pixel.y(), 1.0);
  EXPECT_NEAR(nearest, expected->distance_m - 0.05, 0.002);
}

TEST(LookAt, ShowsATallALongAndAWideBoxAsAWholeAtHalfOfTheHeightOfThePictureOrMore) {
  constexpr int kWidth = 640, kHeight = 400;
  for (const Eigen::Vector3d& size_m :
       {Eigen::Vector3d(0.4, 0.3, 1.7), {2.5, 0.3, 0.2}, {0.3, 2.5, 0.2}, {1.0, 1.0, 1.0}}) {
    SCOPED_TRACE(size_m.transpose());
    const Eigen::Vector3d low_m(3.0, -2.0, 0.1);
    const Eigen::AlignedBox3d box_m(low_m, low_m + size_m);
    const Projector projector(look_at(box_m, {1.9, 3.2, 1.5}), kWidth, kHeight);
    Eigen::AlignedBox2d picture;
    for (int corner = 0; corner < 8; ++corner) {
      const auto projected = projector.project(box_m.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
      ASSERT_TRUE(projected);
      picture.extend(projected->pixel);
    }
    EXPECT_TRUE(Eigen::AlignedBox2d(Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(kWidth, kHeight)).contains(picture));
    EXPECT_GT(picture.sizes().maxCoeff(), 0.5 * kHeight);
  }
}

TEST(CameraRigTest, ChasesFromBehindAndAbove) {
  CameraRig rig(CameraKind::kChase);
  const View view = rig.follow({{10.0, 5.0, 0.3}, quaternion_from_yaw(std::numbers::pi / 2.0)}, 0.05);
  EXPECT_NEAR(view.eye.x(), 10.0, 1e-9);
  EXPECT_LT(view.eye.y(), 5.0);
  EXPECT_GT(view.eye.z(), 0.3);
  EXPECT_GT(view.forward.y(), 0.8);
}

TEST(CameraRigTest, TurnsWithTheRobotButNotAtOnce) {
  CameraRig rig(CameraKind::kChase);
  const Pose3 east{Eigen::Vector3d::Zero(), quaternion_from_yaw(0.0)};
  const Pose3 north{Eigen::Vector3d::Zero(), quaternion_from_yaw(std::numbers::pi / 2.0)};
  rig.follow(east, 0.05);
  EXPECT_GT(rig.follow(north, 0.05).forward.x(), 0.8);
  View view;
  for (int i = 0; i < 100; ++i) view = rig.follow(north, 0.05);
  EXPECT_NEAR(view.forward.x(), 0.0, 1e-3);
}

TEST(CameraRigTest, ComesNearerAtOnceWhereSomethingIsInTheWayAndLeavesSlowly) {
  double free_m = 100.0;
  CameraRig rig(CameraKind::kChase, [&](const auto&, const auto&, double max_m) { return std::min(free_m, max_m); });
  const Pose3 robot{{0.0, 0.0, 0.3}, Eigen::Quaterniond::Identity()};
  const double usual_m = -rig.follow(robot, 0.05).eye.x();
  free_m = 1.25;
  const View near = rig.follow(robot, 0.05);
  EXPECT_NEAR((near.eye - Eigen::Vector3d(0.0, 0.0, 0.7)).norm(), 1.0,
              1e-9);  // 0.25 m before what is in the way
  free_m = 100.0;
  EXPECT_LT(-rig.follow(robot, 0.05).eye.x(), 0.6 * usual_m);
  EXPECT_NEAR(-rig.follow(robot, 10.0).eye.x(), usual_m, 1e-3);
}

/// Nothing in the way, but a roof so high above the ground.
FreeDistance under_roof(double height_m) {
  return [height_m](const Eigen::Vector3d& from_m, const Eigen::Vector3d& direction, double max_m) {
    return direction.z() > 0.9 ? std::min(max_m, height_m - from_m.z()) : max_m;
  };
}

// Half a metre up at 3.3 m ahead.
TEST(CameraRigTest, LooksUpByMoreThanSevenDegreesWhereThereIsARoof) {
  const Pose3 robot{{0.0, 0.0, 0.15}, Eigen::Quaterniond::Identity()};
  CameraRig outdoors(CameraKind::kChase), indoors(CameraKind::kChase, under_roof(7.5));
  const double gained_rad =
      std::asin(indoors.follow(robot, 10.0).forward.z()) - std::asin(outdoors.follow(robot, 10.0).forward.z());
  EXPECT_GT(gained_rad, to_rad(7.0));
  EXPECT_LT(gained_rad, to_rad(9.0));
}

// The eye is 14 m above the body at 0.15 m. The cut is 0.6 of the roof's 7.35 m above it: 14 - 4.41 m from the eye.
TEST(CameraRigTest, FromTheTopARoofIsCutAway) {
  const Pose3 robot{{0.0, 0.0, 0.15}, Eigen::Quaterniond::Identity()};
  EXPECT_NEAR(CameraRig(CameraKind::kTop, under_roof(7.5)).follow(robot, 0.05).near_m, 9.59, 1e-9);
  EXPECT_EQ(CameraRig(CameraKind::kTop, under_roof(100.0)).follow(robot, 0.05).near_m, View{}.near_m);
}

TEST(CameraRigTest, FromTheTopNorthIsUp) {
  const View view = CameraRig(CameraKind::kTop).follow({{3.0, 4.0, 0.3}, quaternion_from_yaw(1.0)}, 0.05);
  EXPECT_NEAR(view.forward.z(), -1.0, 1e-12);
  EXPECT_NEAR(view.up.y(), 1.0, 1e-12);
  EXPECT_NEAR(view.eye.x(), 3.0, 1e-12);
}

TEST(CameraRigTest, OnBoardLooksWhereTheRobotHeads) {
  const View view = CameraRig(CameraKind::kOnboard).follow({{3.0, 4.0, 0.3}, quaternion_from_yaw(1.0)}, 0.05);
  EXPECT_NEAR(std::atan2(view.forward.y(), view.forward.x()), 1.0, 1e-9);
}

TEST(CameraRigTest, OnBoardIsWhereTheRobotHasItsCamera) {
  const View view =
      CameraRig(CameraKind::kOnboard, {}, {0.5, 0.0, 0.25}).follow({{3.0, 4.0, 0.3}, quaternion_from_yaw(0.0)}, 0.05);
  EXPECT_NEAR((view.eye - Eigen::Vector3d(3.5, 4.0, 0.55)).norm(), 0.0, 1e-12);
}

TEST(CameraKindTest, AnUnknownNameIsRefusedWithTheOnesThatAre) {
  EXPECT_EQ(parse_camera_kind("top"), CameraKind::kTop);
  try {
    parse_camera_kind("drone");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "drone: must be one of chase, top, onboard");
  }
}

}  // namespace
}  // namespace patrol::render::camera_test
