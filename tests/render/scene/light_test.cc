#include "render/scene/light.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "io/yaml/settings_yaml.h"
#include "render/scene/scene_painter.h"
#include "tests/render/small_scene.h"

namespace patrol::render::light_test {
namespace {

constexpr int kWidth = 160, kHeight = 90;

constexpr const char* kCave = R"(
  <light pos="0 0 4" dir="0 0 -1" cutoff="80" diffuse="0.7 0.6 0.5" ambient="0 0 0" specular="0 0 0" castshadow="false"/>
  <geom type="plane" size="50 50 1" rgba="0.4 0.4 0.4 1"/>
  <geom type="box" size="0.2 1 1" pos="3 0.5 1" rgba="0.6 0.5 0.4 1"/>
  <geom type="sphere" size="0.3" pos="2 -1 0.8" material="lamp"/>)";
constexpr const char* kLamp = R"(<material name="lamp" rgba="0.6 0.6 0.4 1" emission="0.9" specular="0"/>)";

Frame draw_at(double intensity) {
  const sim::ModelPtr model = small_scene(kCave, kLamp);
  set_light(*model, {.intensity = intensity});
  SceneRenderer painter(*model, kWidth, kHeight);
  Frame frame;
  std::vector<float> depth;
  painter.draw(look_at({-3.0, 0.0, 1.5}, {2.0, 0.0, 1.0}), frame, depth);
  return frame;
}

// Sky, lamp, what it lights and what has only the headlight: nothing here is so bright that a byte cannot hold it.
// To the eye, and in a picture, a share s of the light is s^(1/2.2) of the brightness: 0.2176 of the light is half of
// it.
TEST(Light, AtAFifthOfTheLightEveryPixelIsHalfAsBright) {
  const Frame full = draw_at(1.0), half = draw_at(std::pow(0.5, 2.2));
  constexpr double kRoundingTol = 1.51;  // a byte for the texture, one for the vertex, half of one for the picture
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      ASSERT_NEAR(half.at(x, y).r, 0.5 * full.at(x, y).r, kRoundingTol) << x << ", " << y;
      ASSERT_NEAR(half.at(x, y).b, 0.5 * full.at(x, y).b, kRoundingTol) << x << ", " << y;
    }
  }
}

TEST(Light, WithNoneOfItThePictureIsBlack) { EXPECT_EQ(draw_at(0.0), Frame(kWidth, kHeight)); }

TEST(Light, LessThanNoneOfItIsRefused) {
  try {
    validate(LightSettings{.intensity = -0.1}, "light");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "light.intensity = -0.1: must be in [0, 1]");
  }
}

}  // namespace
}  // namespace patrol::render::light_test
