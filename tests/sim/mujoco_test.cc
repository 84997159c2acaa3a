#include "sim/mujoco.h"

#include <gtest/gtest.h>

namespace patrol::sim::mujoco_test {
namespace {

TEST(Mujoco, ASkyboxWithoutANameIsReplacedByOneTexelAsAnyTexture) {
  const SpecPtr spec = parse_spec(R"(<mujoco><asset>
      <texture type="skybox" builtin="gradient" rgb1=".3 .5 .7" rgb2="0 0 0" width="64" height="384"/>
      <texture name="grid" type="2d" builtin="checker" width="512" height="512"/>
      </asset><worldbody><geom type="plane" size="5 5 1"/></worldbody></mujoco>)");
  drop_textures(*spec);
  const ModelPtr model = compile(*spec, "world");
  EXPECT_EQ(model->ntex, 2);
  EXPECT_EQ(model->ntexdata, 3 * 6 + 3);
}

}  // namespace
}  // namespace patrol::sim::mujoco_test
