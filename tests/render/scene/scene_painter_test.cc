#include "render/scene/scene_painter.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/render/small_scene.h"

namespace patrol::render::scene_painter_test {
namespace {

constexpr int kWidth = 320, kHeight = 180;

constexpr const char* kYard = R"(
  <light directional="true" dir="0.4 0.5 -0.76" diffuse="0.8 0.8 0.8" castshadow="true"/>
  <geom type="plane" size="50 50 1" rgba="0.3 0.6 0.3 1"/>
  <body name="robot" pos="0 0 0.3"><freejoint/><geom type="box" size="0.3 0.15 0.1" rgba="0.9 0.1 0.1 1" group="4"/></body>
  <body name="actor" pos="3 0 0.5" mocap="true"><geom type="box" size="0.2 0.2 0.5" rgba="0.9 0.8 0.1 1"/></body>
  <geom type="box" size="0.5 5 1" pos="8 3 1" rgba="0.5 0.4 0.3 1"/>
  <geom type="box" size="0.5 5 1" pos="-8 3 1" rgba="0.5 0.4 0.3 1"/>
  <geom type="box" size="0.5 0.5 1" pos="-60 3 1" rgba="0.5 0.4 0.3 1"/>
  <geom type="box" size="0.2 0.2 1" pos="1 1 1" rgba="0.2 0.2 0.9 1" group="3"/>)";

const View kFromBehind = look_at({-2.5, 0.0, 1.2}, {0.0, 0.0, 0.3});

class ScenePainterTest : public ::testing::Test {
 protected:
  Frame draw(const View& view) {
    Frame frame;
    painter.draw(view, frame, depth);
    return frame;
  }

  sim::ModelPtr model = small_scene(kYard);
  SceneRenderer painter{*model, kWidth, kHeight};
  std::vector<float> depth;
};

TEST_F(ScenePainterTest, HasSkyAboveGroundBelowAndTheRobotInTheMiddle) {
  painter.set_state(reference_state(*model));
  const Frame frame = draw(kFromBehind);
  const Color sky = frame.at(20, 3), ground = frame.at(20, kHeight - 3), robot = frame.at(kWidth / 2, kHeight / 2);
  EXPECT_GT(sky.b, sky.r);
  EXPECT_GT(ground.g, ground.b);
  EXPECT_GT(robot.r, 2 * robot.g);
}

TEST_F(ScenePainterTest, ThrowsAShadowAwayFromTheSun) {
  painter.set_state(reference_state(*model));
  const View above = look_at({0.0, 0.0, 5.0}, {0.0, 0.0, 0.0});
  const Frame frame = draw(above);
  const Projector projector(above, kWidth, kHeight);
  const auto green_at = [&](double x, double y) {
    const Eigen::Vector2d pixel = projector.project({x, y, 0.0})->pixel;
    return static_cast<int>(frame.at(static_cast<int>(pixel.x()), static_cast<int>(pixel.y())).g);
  };
  EXPECT_LT(green_at(0.30, 0.30), green_at(-0.45, -0.45) - 20);  // the sun is in the south-west
}

TEST_F(ScenePainterTest, PutsRobotAndActorsWhereTheStateHasThem) {
  SimState state = reference_state(*model);
  state.qpos[1] = 2.0;
  state.mocap[1] = -2.0;
  painter.set_state(state);
  const View above = look_at({0.0, 0.0, 9.0}, {0.0, 0.0, 0.0});
  const Frame frame = draw(above);
  const Projector projector(above, kWidth, kHeight);
  const auto color_at = [&](const Eigen::Vector3d& p) {
    const Eigen::Vector2d pixel = projector.project(p)->pixel;
    return frame.at(static_cast<int>(pixel.x()), static_cast<int>(pixel.y()));
  };
  const Color robot = color_at({0.0, 2.0, 0.4}), actor = color_at({3.0, -2.0, 1.0});
  EXPECT_GT(robot.r, 2 * robot.g);
  EXPECT_GT(actor.r, 2 * actor.b);
  EXPECT_GT(2 * actor.g, actor.r);
}

TEST_F(ScenePainterTest, WhatItLeavesOutWouldNotHaveBeenSeen) {
  painter.set_state(reference_state(*model));
  Frame frame;
  painter.draw(kFromBehind, frame, depth);
  const int num_drawn = painter.scene().ngeom;
  // The same scene once more, whole: MuJoCo's list without the painter's choice.
  mjvScene& scene = painter.scene();
  mjvOption options;
  mjv_defaultOption(&options);
  for (const int group : {2, 3, 5}) options.geomgroup[group] = 0;
  options.geomgroup[4] = 1;
  float sun_place[mjMAXLIGHT][3];
  for (int i = 0; i < scene.nlight; ++i) std::copy(scene.lights[i].pos, scene.lights[i].pos + 3, sun_place[i]);
  auto data = sim::make_data(*model);
  mj_forward(model.get(), data.get());
  mjv_updateScene(model.get(), data.get(), &options, nullptr, nullptr, mjCAT_ALL, &scene);
  for (int i = 0; i < scene.nlight; ++i) std::copy(sun_place[i], sun_place[i] + 3, scene.lights[i].pos);
  EXPECT_GT(scene.ngeom, num_drawn) << "nothing was left out";
  Frame whole;
  painter.offscreen().render(scene);
  painter.offscreen().read(whole);
  EXPECT_EQ(frame, whole);
}

TEST_F(ScenePainterTest, GivesTheSamePixelsForTheSameState) {
  painter.set_state(reference_state(*model));
  const Frame first = draw(kFromBehind);
  draw(look_at({5.0, 5.0, 2.0}, {0.0, 0.0, 0.0}));
  EXPECT_EQ(draw(kFromBehind), first);
}

TEST_F(ScenePainterTest, RefusesAStateOfAnotherModel) {
  SimState state = reference_state(*model);
  state.qpos.push_back(0.0);
  EXPECT_THROW(painter.set_state(state), InputError);
  state = reference_state(*model);
  state.mocap.clear();
  EXPECT_THROW(painter.set_state(state), InputError);
}

/// A post of 0.4 m between two lamps 4 m up, both in sight of it.
constexpr const char* kPostBetweenLamps = R"(
  <light pos="-2 0 4" dir="0 0 -1" cutoff="80" exponent="1" diffuse="0.6 0.6 0.6" castshadow="false"/>
  <light pos="30 0 4" dir="0 0 -1" cutoff="80" exponent="1" diffuse="0.6 0.6 0.6" castshadow="false"/>
  <geom type="plane" size="3 3 1" rgba="0.5 0.5 0.5 1"/>
  <geom type="box" size="0.1 0.3 0.5" pos="0 0 0.5" rgba="0.5 0.1 0.1 1"/>)";

// The lamp over x = -2 m, 4 m up, throws the shadow of the post's upper edge, 1 m up, to x = 0.8 m.
TEST(ScenePainterUnderLamps, TheNearestOneThrowsShadows) {
  const sim::ModelPtr model = small_scene(kPostBetweenLamps);
  SceneRenderer painter(*model, kWidth, kHeight);
  const View above = look_at({0.0, 0.0, 5.0}, {0.0, 0.0, 0.0});
  Frame frame;
  std::vector<float> depth;
  painter.draw(above, frame, depth);
  const Projector projector(above, kWidth, kHeight);
  const auto green_at = [&](double x, double y) {
    const Eigen::Vector2d pixel = projector.project({x, y, 0.0})->pixel;
    return static_cast<int>(frame.at(static_cast<int>(pixel.x()), static_cast<int>(pixel.y())).g);
  };
  EXPECT_LT(green_at(0.45, 0.0), green_at(0.45, 1.2) - 20);
  EXPECT_GT(green_at(-0.45, 0.0), green_at(0.45, 0.0) + 20);
  EXPECT_NEAR(green_at(1.2, 0.0), green_at(1.2, 1.2), 10);  // the shadow ends
}

// 0.6 of the cutoff of 80 degrees is what a shadow map covers: over 10 m, seen from 4 m up, it is too far.
TEST(ScenePainterUnderLamps, FarFromAllOfThemThereAreNoShadows) {
  const sim::ModelPtr model = small_scene(kPostBetweenLamps);
  SceneRenderer painter(*model, kWidth, kHeight);
  Frame frame;
  std::vector<float> depth;
  const auto num_casting = [&](double x_m) {
    painter.draw(look_at({x_m, 0.0, 5.0}, {x_m, 0.0, 0.0}), frame, depth);
    const mjvScene& scene = painter.scene();
    return std::count_if(scene.lights, scene.lights + scene.nlight,
                         [](const mjvLight& light) { return light.castshadow != 0 && !light.headlight; });
  };
  EXPECT_EQ(num_casting(0.0), 1);
  EXPECT_EQ(num_casting(10.0), 0);
  EXPECT_EQ(num_casting(29.0), 1);
}

// Along the way from one lamp to the other, the brightness of a place behind a post never jumps: shadows fade in and
// out.
TEST(ScenePainterUnderLamps, ShadowsDoNotPop) {
  const sim::ModelPtr model = small_scene(R"(
  <light pos="0 0 4" dir="0 0 -1" cutoff="80" exponent="1" diffuse="0.6 0.6 0.6" castshadow="false"/>
  <light pos="8 0 4" dir="0 0 -1" cutoff="80" exponent="1" diffuse="0.6 0.6 0.6" castshadow="false"/>
  <geom type="plane" size="30 30 1" rgba="0.5 0.5 0.5 1"/>
  <geom type="box" size="0.1 0.3 0.5" pos="2 0 0.5" rgba="0.5 0.1 0.1 1"/>)");
  SceneRenderer painter(*model, kWidth, kHeight);
  Frame frame;
  std::vector<float> depth;
  int last = -1, brightest = 0, darkest = 255;
  for (double focus_x = 0.0; focus_x <= 8.0; focus_x += 0.05) {
    View above = look_at({2.0, 0.0, 6.0}, {2.0, 0.0, 0.0});  // the eye stays: only what the light is chosen by moves
    above.focus = {focus_x, 0.0, 0.0};
    painter.draw(above, frame, depth);
    const Eigen::Vector2d pixel =
        Projector(above, kWidth, kHeight).project({2.4, 0.0, 0.0})->pixel;  // in the first lamp's shadow
    const int bright = frame.at(static_cast<int>(pixel.x()), static_cast<int>(pixel.y())).g;
    if (last >= 0) {
      EXPECT_LE(std::abs(bright - last), 12) << "at " << focus_x;
    }
    last = bright;
    brightest = std::max(brightest, bright);
    darkest = std::min(darkest, bright);
  }
  EXPECT_GT(brightest, darkest + 20) << "there was a shadow, and there was none";
}

// Koschmieder: of the contrast to the fog's colour, exp(-0.2 d) is left after d metres.
TEST(ScenePainterInDust, WhatIsFarTakesTheColourOfTheFogAndWhatIsNearDoesNot) {
  const sim::ModelPtr model = small_scene(kYard);
  constexpr float kFog = 0.6f;
  std::fill(model->vis.rgba.fog, model->vis.rgba.fog + 3, kFog);
  const View view = kFromBehind;
  Frame clear, dusty;
  std::vector<float> depth;
  SceneRenderer(*model, kWidth, kHeight).draw(view, clear, depth);
  SceneRenderer(*model, kWidth, kHeight, 0.2).draw(view, dusty, depth);
  const Projector projector(view, kWidth, kHeight);
  const auto expect_haze = [&](const Eigen::Vector3d& point_m) {
    const Eigen::Vector2d pixel = projector.project(point_m)->pixel;
    const int x = static_cast<int>(pixel.x()), y = static_cast<int>(pixel.y());
    const double left = std::exp(-0.2 * (point_m - view.eye).norm());
    EXPECT_NEAR(dusty.at(x, y).r, 255.0 * kFog + left * (clear.at(x, y).r - 255.0 * kFog), 2.0) << point_m.transpose();
  };
  expect_haze({-0.3, 0.0, 0.3});  // the robot, 2.4 m away
  expect_haze({7.5, 3.0, 0.5});   // the wall, 10.5 m away
}

TEST(OffscreenTest, RefusesASizeWithoutPixels) {
  const auto model = small_scene(R"(<geom size="1"/>)");
  EXPECT_THROW(Offscreen(*model, 0, 100), std::runtime_error);
}

}  // namespace
}  // namespace patrol::render::scene_painter_test
