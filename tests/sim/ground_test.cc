#include "sim/ground.h"

#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sim/mujoco.h"
#include "sim/static_obstacles.h"

namespace patrol::sim::ground_test {
namespace {

TEST(Ground, APatternMatchesTheWholeNameAndStarsStandForAnyText) {
  EXPECT_TRUE(matches("ground", "ground"));
  EXPECT_FALSE(matches("ground", "ground_1"));
  EXPECT_TRUE(matches("ground*", "ground"));
  EXPECT_TRUE(matches("ground*", "ground_1"));
  EXPECT_FALSE(matches("ground*", "playground"));
  EXPECT_TRUE(matches("*ground", "playground"));
  EXPECT_TRUE(matches("a*b*c", "a1b2c"));
  EXPECT_FALSE(matches("a*b*c", "a1b2"));
  EXPECT_TRUE(matches("*", ""));
}

/// Ball that rests on, or is pushed against, one geom.
class BallOn {
 public:
  BallOn(const std::string& geom, const std::string& ball_position, const GroundSettings& settings,
         const std::vector<StaticObstacleSettings>& obstacles = {})
      : spec_(
            parse_spec("<mujoco><compiler angle=\"degree\"/><asset><material name=\"asphalt_2\"/></asset><worldbody>" +
                       geom + "<body pos=\"" + ball_position +
                       "\"><freejoint/><geom name=\"ball\" type=\"sphere\" size=\"0.1\" mass=\"1\"/></body>"
                       "</worldbody></mujoco>")) {
    add_static_obstacles(*spec_, obstacles);
    model_ = compile(*spec_, "ball");
    data_ = make_data(*model_);
    mj_forward(model_.get(), data_.get());
    ground_.emplace(settings, *model_);
  }

  int num_contacts() const { return data_->ncon; }
  /// Whether the first contact is one with the ground, for a lowest contact at this height.
  bool is_footing(double lowest_m) const {
    const mjContact& contact = data_->contact[0];
    const int ball = mj_name2id(model_.get(), mjOBJ_GEOM, "ball");
    const int other = contact.geom[0] == ball ? contact.geom[1] : contact.geom[0];
    return ground_->is_footing(*model_, *data_, contact, other, lowest_m);
  }
  SurfaceClass class_of(const char* geom) const {
    return ground_->class_of(mj_name2id(model_.get(), mjOBJ_GEOM, geom));
  }

 private:
  SpecPtr spec_;
  ModelPtr model_;
  DataPtr data_;
  std::optional<Ground> ground_;
};

// The top of the box is at 0.4 m.
constexpr const char* kBox = R"(<geom name="stage" type="box" size="1 1 0.2" pos="0 0 0.2"/>)";
constexpr const char* kOnTop = "0 0 0.499";
constexpr const char* kAtSide = "1.099 0 0.2";

TEST(Ground, ByHeightAStepUpTo25CentimetersFromAboveIsGroundAndAHigherOneIsNot) {
  const BallOn ball(kBox, kOnTop, {});
  ASSERT_EQ(ball.num_contacts(), 1);
  EXPECT_EQ(ball.class_of("stage"), SurfaceClass::kByContact);
  EXPECT_TRUE(ball.is_footing(0.4));
  EXPECT_TRUE(ball.is_footing(0.16));
  EXPECT_FALSE(ball.is_footing(0.14));
}

TEST(Ground, ByHeightABoxAsLowAsACurbIsGroundAtItsSides) {
  const BallOn ball(kBox, kAtSide, {});
  EXPECT_TRUE(ball.is_footing(0.26));
  EXPECT_FALSE(ball.is_footing(0.24));
}

// The box hangs over the ball.
TEST(Ground, AContactFromBelowIsACollision) {
  const BallOn ball(R"(<geom name="stage" type="box" size="1 1 0.2" pos="0 0 0.4"/>)", "0 0 0.101", {});
  ASSERT_EQ(ball.num_contacts(), 1);
  EXPECT_FALSE(ball.is_footing(0.1));
}

TEST(Ground, ByHeightTheSideOfABoxIsACollision) {
  const BallOn ball(kBox, kAtSide, {});
  ASSERT_EQ(ball.num_contacts(), 1);
  EXPECT_FALSE(ball.is_footing(0.2));
}

TEST(Ground, AGeomNamedAsGroundIsGroundAtItsSides) {
  const BallOn ball(kBox, kAtSide, {.all = {.geoms = {"st*"}}, .max_step_m = 0.0});
  EXPECT_EQ(ball.class_of("stage"), SurfaceClass::kGround);
  EXPECT_TRUE(ball.is_footing(-5.0));
}

TEST(Ground, IsSelectedByMaterialAndByGroup) {
  const char* const geom =
      R"(<geom name="road" type="box" size="1 1 0.2" pos="0 0 0.2" material="asphalt_2" group="2"/>)";
  EXPECT_EQ(BallOn(geom, kAtSide, {.all = {.materials = {"asphalt*"}}, .max_step_m = 0.0}).class_of("road"),
            SurfaceClass::kGround);
  EXPECT_EQ(BallOn(geom, kAtSide, {.all = {.groups = {"2"}}, .max_step_m = 0.0}).class_of("road"),
            SurfaceClass::kGround);
  EXPECT_EQ(BallOn(geom, kAtSide, {.all = {.groups = {"3"}}, .max_step_m = 0.0}).class_of("road"),
            SurfaceClass::kObstacle);
}

TEST(Ground, ACurbIsGroundFromAboveAndAtItsSidesUpTo15CentimetersAboveTheLowestContact) {
  const GroundSettings settings{.curbs = {.geoms = {"stage"}}, .max_step_m = 0.0};
  EXPECT_TRUE(BallOn(kBox, kOnTop, settings).is_footing(-5.0));
  EXPECT_TRUE(BallOn(kBox, kAtSide, settings).is_footing(0.26));
  EXPECT_FALSE(BallOn(kBox, kAtSide, settings).is_footing(0.24));
}

TEST(Ground, MovingBodiesAndObstaclesOfTheScenarioAreNeverGroundByHeight) {
  const BallOn ball(R"(<geom name="floor" type="plane" size="5 5 1"/><body name="cart" mocap="true" pos="3 0 0.1">
                       <geom name="cart" type="box" size="0.5 0.5 0.1"/></body>)",
                    "0 0 0.099", {}, {{.kind = "brick", .x_m = -2.0}});
  EXPECT_EQ(ball.class_of("floor"), SurfaceClass::kByContact);
  EXPECT_EQ(ball.class_of("cart"), SurfaceClass::kObstacle);
  EXPECT_EQ(ball.class_of("static_obstacle_1"), SurfaceClass::kObstacle);
  EXPECT_TRUE(ball.is_footing(0.0));
}

}  // namespace
}  // namespace patrol::sim::ground_test
