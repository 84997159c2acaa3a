#include "render/film/shot_camera.h"

#include <gtest/gtest.h>

namespace patrol::render::shot_camera_test {
namespace {

constexpr double kFrame_s = 1.0 / 30.0;
const Pose3 kOrigin{{0.0, 0.0, 0.3}, Eigen::Quaterniond::Identity()};

bool is_in_picture(const View& view, const Eigen::Vector3d& point) {
  const auto seen = Projector(view, 1280, 720).project(point);
  return seen && seen->pixel.x() > 0.0 && seen->pixel.x() < 1280.0 && seen->pixel.y() > 0.0 && seen->pixel.y() < 720.0;
}

TEST(ShotCamera, BesideTheRobotLooksAtItFromAhead) {
  const Shot shot{.span = {}, .kind = ShotKind::kClose, .caption = {}, .T_world_body = kOrigin};
  const View view = ShotCamera(shot, {}, kOrigin).follow(kOrigin, {0.0, 0.0}, kFrame_s);
  EXPECT_GT(view.eye.x(), 0.5);
  EXPECT_TRUE(is_in_picture(view, kOrigin.position));
}

TEST(ShotCamera, OfTwoHasBothInThePicture) {
  const Eigen::Vector2d subject(0.0, 2.5);
  const Shot shot{
      .span = {}, .kind = ShotKind::kTwoSubjects, .caption = {}, .T_world_body = kOrigin, .p_world_subject = subject};
  const View view = ShotCamera(shot, {}, kOrigin).follow(kOrigin, {0.0, 0.0}, kFrame_s);
  EXPECT_TRUE(is_in_picture(view, kOrigin.position));
  EXPECT_TRUE(is_in_picture(view, {subject.x(), subject.y(), 0.5}));
}

TEST(ShotCamera, OfASubjectFiveMetersUpLooksUpwardFromTheHeightOfTheRobot) {
  const Shot shot{.span = {},
                  .kind = ShotKind::kTwoSubjects,
                  .caption = {},
                  .T_world_body = kOrigin,
                  .p_world_subject = Eigen::Vector2d(0.0, 2.0),
                  .subject_height_m = 5.0};
  const View view = ShotCamera(shot, {}, kOrigin).follow(kOrigin, {0.0, 0.0}, kFrame_s);
  EXPECT_GT(view.forward.z(), 0.1);
  EXPECT_NEAR(view.eye.z(), kOrigin.position.z(), 0.5);
  EXPECT_TRUE(is_in_picture(view, {0.0, 2.0, 5.3}));
}

TEST(ShotCamera, DoesNotGoWhereAWallIs) {
  const auto wall_on_the_left = [](const Eigen::Vector3d& from, const Eigen::Vector3d& direction, double max_m) {
    return direction.y() > 1e-9 ? std::min(max_m, (0.5 - from.y()) / direction.y()) : max_m;
  };
  const Shot shot{.span = {}, .kind = ShotKind::kClose, .caption = {}, .T_world_body = kOrigin};
  ShotCamera camera(shot, wall_on_the_left, kOrigin);
  EXPECT_LT(camera.follow(kOrigin, {0.0, 0.0}, kFrame_s).eye.y(), 0.0);
}

TEST(ShotCamera, FromAboveHasTheRobotAndWhereItBelievesToBe) {
  const Shot shot{.span = {}, .kind = ShotKind::kOverhead, .caption = {}, .T_world_body = kOrigin};
  ShotCamera camera(shot, {}, kOrigin);
  View view;
  for (int frame = 0; frame < 90; ++frame) view = camera.follow(kOrigin, {-22.0, 0.0}, kFrame_s);
  EXPECT_TRUE(is_in_picture(view, kOrigin.position));
  EXPECT_TRUE(is_in_picture(view, {-22.0, 0.0, 0.3}));
}

}  // namespace
}  // namespace patrol::render::shot_camera_test
