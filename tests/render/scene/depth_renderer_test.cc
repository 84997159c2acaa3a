#include "render/scene/depth_renderer.h"

#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "sim/lidar_scene.h"
#include "tests/render/small_scene.h"

namespace patrol::render::depth_renderer_test {
namespace {

constexpr sim::PinholeLens kLens{.width_px = 80, .height_px = 60, .focal_px = 57.0};

/// Every kind of shape between 0.5 and 6 m ahead of the camera, which stands 0.5 m above the ground.
constexpr const char* kShapes = R"(
  <geom type="plane" size="0 0 1"/>
  <geom type="box" pos="3 0.8 0.3" size="0.3 0.2 0.3" euler="0 0 30"/>
  <geom type="sphere" pos="2.2 -0.5 0.3" size="0.3"/>
  <geom type="capsule" pos="2.5 0.3 0.6" size="0.1 0.4" euler="20 30 0"/>
  <geom type="cylinder" pos="4 -1 0.8" size="0.4 0.8"/>
  <geom type="ellipsoid" pos="1.6 0.55 0.2" size="0.3 0.15 0.2"/>
  <geom type="box" pos="6 0 1.5" size="0.1 8 1.5"/>)";

struct Look {
  Look(const std::string& geoms, const Pose3& T_world_camera, double near_m = 0.1, double far_m = 10.0)
      : model(small_scene(geoms)), data(sim::make_data(*model)), T(T_world_camera) {
    mj_forward(model.get(), data.get());
    DepthRenderer renderer(*model, kLens, near_m, far_m);
    renderer.draw({*model, *data}, T, image);
    num_drawn = renderer.num_drawn();
  }
  float depth_m(int u, int v) const { return image.depth_m[static_cast<std::size_t>(80 * v + u)]; }
  float reflectivity(int u, int v) const { return image.reflectivity[static_cast<std::size_t>(80 * v + u)]; }

  sim::ModelPtr model;
  sim::DataPtr data;
  Pose3 T;
  sim::IdealDepthImage image;
  int num_drawn = 0;
};

const Pose3 kAhead{{0.0, 0.0, 0.5}, Eigen::Quaterniond::Identity()};

/// Largest difference of a pixel from the ray through its middle, where its neighbours' rays agree that there is no
/// edge.
double worst_against_rays(const Look& look, double up_to_m, int* compared) {
  sim::LidarScene scene(*look.model);
  scene.update(*look.data);
  const auto ray_depth_m = [&](double u, double v) {
    const Eigen::Vector3d pixel(1.0, -(u - kLens.cx_px()) / kLens.focal_px, -(v - kLens.cy_px()) / kLens.focal_px);
    const auto hit = scene.cast(look.T.position, look.T.rotation * pixel.normalized(), 30.0, sim::kRayEverything);
    return hit ? hit->distance_m / pixel.norm() : 1e9;
  };
  double worst = 0.0;
  *compared = 0;
  for (int v = 0; v < 60; ++v) {
    for (int u = 0; u < 80; ++u) {
      const double expected = ray_depth_m(u, v);
      if (expected > up_to_m) continue;
      constexpr double kBeside_px = 0.3, kSame_m = 0.1;  // the drawn shape's outline may be that far from the true one
      bool is_edge = false;
      for (const double side : {-kBeside_px, kBeside_px}) {
        is_edge = is_edge || std::abs(ray_depth_m(u + side, v) - expected) > kSame_m ||
                  std::abs(ray_depth_m(u, v + side) - expected) > kSame_m;
      }
      if (is_edge) continue;
      ++*compared;
      worst = std::max(worst, std::abs(static_cast<double>(look.depth_m(u, v)) - expected));
    }
  }
  return worst;
}

TEST(DepthRenderer, EveryShapeIsWithin1CentimetreOfRaysUpTo3Metres) {
  int compared = 0;
  EXPECT_LT(worst_against_rays(Look(kShapes, kAhead), 3.0, &compared), 0.01);
  EXPECT_GT(compared, 1500);
}

TEST(DepthRenderer, SoItIsRolledAndPitchedAndTurned) {
  const Pose3 tilted{{0.3, -0.4, 0.7}, quaternion_from_rpy(0.2, 0.15, 0.25)};
  int compared = 0;
  EXPECT_LT(worst_against_rays(Look(kShapes, tilted), 3.0, &compared), 0.01);
  EXPECT_GT(compared, 1500);
}

TEST(DepthRenderer, AWallIsFlatToATenthOfAMillimetreAt7MetresFromANearPlaneOf5Centimetres) {
  const Look look(R"(<geom type="box" pos="7.5 0 0" size="0.5 20 20"/>)", kAhead, 0.05, 12.0);
  for (const float depth_m : look.image.depth_m) EXPECT_NEAR(depth_m, 7.0, 1e-4);
}

TEST(DepthRenderer, AnEndlessPlaneIsUnderTheCameraAlsoFarFromItsOrigin) {
  const Look look(R"(<geom type="plane" size="0 0 1"/>)", {{300.0, -200.0, 0.5}, Eigen::Quaterniond::Identity()});
  // Row 58 is 28.5 px below the middle: 0.5 m / (28.5 / 57) = 1 m. Floats lose 15 um at 300 m.
  for (const int u : {0, 40, 79}) EXPECT_NEAR(look.depth_m(u, 58), 1.0, 2e-4);
}

TEST(DepthRenderer, TheFirstRowIsTheTopAndTheFirstColumnTheLeft) {
  const Look look(R"(<geom type="box" pos="2 1 1.3" size="0.1 0.2 0.2"/>)", kAhead);
  // 1 m to the left, 0.8 m up, front at 1.9 m: column 39.5 - 57 / 1.9 = 9.5, row 29.5 - 57 x 0.8 / 1.9 = 5.5.
  EXPECT_NEAR(look.depth_m(9, 5), 1.9, 1e-3);
  EXPECT_TRUE(std::isinf(look.depth_m(70, 5)));
  EXPECT_TRUE(std::isinf(look.depth_m(9, 54)));
}

TEST(DepthRenderer, BeyondTheFarPlaneThereIsNothing) {
  const Look look(R"(<geom type="box" pos="11 0 0" size="0.5 20 20"/>)", kAhead);
  EXPECT_TRUE(std::isinf(look.depth_m(40, 30)));
  EXPECT_EQ(look.reflectivity(40, 30), 0.0f);
}

TEST(DepthRenderer, ReflectivityIsTheLuminanceOfTheColourToOneIn254) {
  const Look look(R"(<geom type="box" pos="2 1 0.5" size="0.1 0.9 2" rgba="1 1 1 1"/>
                     <geom type="box" pos="2 -1 0.5" size="0.1 0.9 2" rgba="0.2 0.4 0.1 1"/>)",
                  kAhead);
  EXPECT_NEAR(look.reflectivity(10, 30), 1.0, 1.0 / 254.0);
  EXPECT_NEAR(look.reflectivity(70, 30), 0.2126 * 0.2 + 0.7152 * 0.4 + 0.0722 * 0.1, 0.5 / 254.0 + 1e-6);
}

TEST(DepthRenderer, OwnHousingGlassAndWhatIsNotForTheEyeDoNotHideTheWall) {
  const Look look(R"(<geom type="box" pos="4.1 0 0" size="0.1 5 5"/>
      <geom type="box" pos="2 0 0.5" size="0.1 5 5" rgba="0.7 0.8 0.9 0.2"/>
      <geom type="box" pos="2 0 0.5" size="0.1 5 5" group="2"/><geom type="box" pos="2 0 0.5" size="0.1 5 5" group="3"/>
      <body name="base_link"><freejoint/><geom type="box" size="0.1 0.1 0.1" pos="-1 0 0" group="4"/>
        <body name="depth_camera" pos="0 0 0.5"><geom type="box" size="0.12 0.2 0.2" group="4"/></body></body>)",
                  kAhead);
  EXPECT_NEAR(look.depth_m(40, 30), 4.0, 1e-3);
}

/// A wavy wall along y from -40 m to 40 m, 0.2 m a step and 3 m high: 800 x 2 faces.
std::string long_wall_asset() {
  constexpr int kSteps = 401;
  std::string vertices, faces;
  for (int i = 0; i < kSteps; ++i) {
    const double y = -40.0 + 0.2 * i, x = 5.0 + 0.2 * std::sin(0.7 * y);
    for (const double z : {-1.0, 0.5, 2.0})
      vertices += std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + " ";
    if (i == 0) continue;
    for (const int low : {3 * i, 3 * i + 1}) {
      for (const int corner : {low - 3, low, low + 1, low - 3, low + 1, low - 2}) faces += std::to_string(corner) + " ";
    }
  }
  return "<mesh name=\"wall\" inertia=\"shell\" vertex=\"" + vertices + "\" face=\"" + faces + "\"/>";
}

TEST(DepthRenderer, OfALongMeshOnlyWhatIsNearIsDrawnAndTheDepthIsThatOfRaysAlongAllOfIt) {
  Look look(kShapes, kAhead);  // for its comparison
  look.model =
      sim::compile(*sim::parse_spec("<mujoco><asset>" + long_wall_asset() +
                                    R"(</asset><worldbody><geom type="mesh" mesh="wall"/></worldbody></mujoco>)"),
                   "wall");
  look.data = sim::make_data(*look.model);
  mj_forward(look.model.get(), look.data.get());
  DepthRenderer renderer(*look.model, kLens, 0.1, 10.0);
  for (double y = -30.0; y < 30.0; y += 1.3) {
    look.T.position = {0.0, y, 0.5};
    renderer.draw({*look.model, *look.data}, look.T, look.image);
    int compared = 0;
    EXPECT_LT(worst_against_rays(look, 7.0, &compared), 0.001) << y;
    EXPECT_GT(compared, 1000) << y;
    EXPECT_LT(renderer.num_near_faces(), 800);
  }
}

TEST(DepthRenderer, ThinBarsAreWithin1CentimetreAndEndWhereTheyEnd) {
  const Look look(R"(<geom type="capsule" pos="0.8 0 0.5" euler="90 0 0" size="0.03 0.2"/>
      <geom type="cylinder" pos="1 0.45 0.5" euler="0 20 0" size="0.03 0.3"/>
      <geom type="box" pos="3 0 0" size="0.1 5 5"/>)",
                  kAhead);
  int compared = 0;
  EXPECT_LT(worst_against_rays(look, 2.0, &compared), 0.01);
  EXPECT_GT(compared, 100);
  // The capsule lies across the way from y = -0.23 to 0.23, its front at 0.77: 57 x 0.23 / 0.77 = 17 pixels each side
  // of 39.5.
  EXPECT_LT(look.depth_m(39 + 16, 30), 0.8);
  EXPECT_GT(look.depth_m(39 + 19, 30), 2.0);
}

TEST(DepthRenderer, ARobotsOwnArmBeforeTheCameraIsSeenWhereItsBodyIs) {
  Look look(R"(<body name="base_link"><freejoint/><geom type="box" size="0.1 2 2" pos="1 0 0" group="4"/></body>)",
            kAhead);
  EXPECT_NEAR(look.depth_m(40, 30), 0.9, 1e-4);
  DepthRenderer renderer(*look.model, kLens, 0.1, 10.0);
  look.data->qpos[0] = 1.5;
  mj_kinematics(look.model.get(), look.data.get());
  renderer.draw({*look.model, *look.data}, look.T, look.image);
  EXPECT_NEAR(look.depth_m(40, 30), 2.4, 1e-4);
}

TEST(DepthRenderer, WhatIsBehindBesideAndTooFarIsNotDrawn) {
  const Look look(
      R"(<geom type="box" pos="3 0 0.5" size="0.1 0.1 0.1"/><geom type="box" pos="-3 0 0.5" size="0.1 0.1 0.1"/>
      <geom type="box" pos="1 3 0.5" size="0.1 0.1 0.1"/><geom type="box" pos="13 0 0.5" size="0.1 0.1 0.1"/>)",
      kAhead);
  EXPECT_EQ(look.num_drawn, 1);
}

TEST(DepthRenderer, TwoInOneThreadTakeTurns) {
  const sim::ModelPtr near_wall = small_scene(R"(<geom type="box" pos="2.1 0 0" size="0.1 5 5"/>)"),
                      far_wall = small_scene(R"(<geom type="box" pos="5.1 0 0" size="0.1 5 5"/>)");
  const sim::DataPtr near_data = sim::make_data(*near_wall), far_data = sim::make_data(*far_wall);
  DepthRenderer near_camera(*near_wall, kLens, 0.1, 10.0), far_camera(*far_wall, kLens, 0.1, 10.0);
  sim::IdealDepthImage image;
  for (int round = 0; round < 3; ++round) {
    near_camera.draw({*near_wall, *near_data}, kAhead, image);
    EXPECT_NEAR(image.depth_m[2440], 2.0, 1e-4);
    far_camera.draw({*far_wall, *far_data}, kAhead, image);
    EXPECT_NEAR(image.depth_m[2440], 5.0, 1e-4);
  }
}

}  // namespace
}  // namespace patrol::render::depth_renderer_test
