#include "render/film/approach.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/render/small_scene.h"

namespace patrol::render::approach_test {
namespace {

/// The robot's box reaches from x = -0.3 m to 0.3 m, from y = -0.15 m to 0.15 m. The walker is a cylinder of 0.2 m, its
/// leg one of 0.1 m.
constexpr const char* kRobotAndWalker = R"(
  <body name="base_link" pos="0 0 0.3"><freejoint/><geom type="box" size="0.3 0.15 0.1" group="4"/></body>
  <body name="walker" pos="10 0 1" mocap="true"><geom type="cylinder" size="0.2 0.9"/></body>
  <body name="walker_leg" pos="10 0 0.4" mocap="true"><geom type="sphere" size="0.1"/></body>)";
constexpr double kGeometryTol_m = 1e-3;  // of MuJoCo's iteration

class ApproachFinderTest : public ::testing::Test {
 protected:
  SimState with_walker(double x, double leg_x) const {
    SimState state = reference_state(*model);
    state.stamp = std::chrono::seconds(7);
    state.mocap[0] = x;
    state.mocap[7] = leg_x;
    return state;
  }
  sim::ModelPtr model = small_scene(kRobotAndWalker);
  ApproachFinder finder{*model};
};

TEST_F(ApproachFinderTest, MeasuresFromSkinToSkin) {
  const auto nearest = finder.nearest(with_walker(1.2, 10.0));
  ASSERT_TRUE(nearest);
  EXPECT_NEAR(nearest->clearance_m, 1.2 - 0.2 - 0.3, kGeometryTol_m);
  EXPECT_EQ(nearest->actor, "walker");
  EXPECT_EQ(nearest->at, Time(std::chrono::seconds(7)));
}

TEST_F(ApproachFinderTest, ALegIsPartOfItsWalker) {
  const auto nearest = finder.nearest(with_walker(1.2, 0.9));
  ASSERT_TRUE(nearest);
  EXPECT_NEAR(nearest->clearance_m, 0.9 - 0.1 - 0.3, kGeometryTol_m);
  EXPECT_EQ(nearest->actor, "walker");
  EXPECT_NEAR(nearest->p_world_actor.x(), 1.2, 1e-12);
}

TEST_F(ApproachFinderTest, AnUnnamedBodyIsCalledByItsNumberAndHasNoLimbs) {
  const sim::ModelPtr scene = small_scene(R"(
    <body name="base_link" pos="0 0 0.3"><freejoint/><geom type="box" size="0.3 0.15 0.1" group="4"/></body>
    <body pos="10 0 1" mocap="true"><geom type="cylinder" size="0.2 0.9"/></body>
    <body name="_cart" pos="10 0 0.4" mocap="true"><geom type="sphere" size="0.1"/></body>)");
  SimState state = reference_state(*scene);
  state.mocap[0] = 1.2;
  const int unnamed = mj_name2id(scene.get(), mjOBJ_BODY, "base_link") + 1;
  EXPECT_EQ(ApproachFinder(*scene).nearest(state).value().actor, "body " + std::to_string(unnamed));
  state.mocap[7] = 0.9;
  EXPECT_EQ(ApproachFinder(*scene).nearest(state).value().actor, "_cart");
}

TEST_F(ApproachFinderTest, WhatIsFarOffIsNoApproach) { EXPECT_FALSE(finder.nearest(with_walker(3.0, 3.0))); }

TEST_F(ApproachFinderTest, RefusesAStateOfAnotherModel) { EXPECT_THROW(finder.nearest(SimState{}), InputError); }

}  // namespace
}  // namespace patrol::render::approach_test
