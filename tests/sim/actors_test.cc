#include "sim/actors.h"

#include <cmath>
#include <functional>
#include <numbers>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/sim/small_world.h"

namespace patrol::sim::actors_test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr Time kTick = std::chrono::milliseconds(2);
const ObservedRobot kFarAway{.p_world = {1000.0, 1000.0}};

/// A walker with legs and a cart, on the ground and on a pavement 0.1 m high beyond x = 10 m.
const std::string kTraffic = R"(<geom type="plane" size="50 50 1"/>
  <geom type="box" pos="20 0 0.05" size="10 50 0.05"/>
  <body name="walker" mocap="true" pos="0 0 0.86"><geom size="0.1"/></body>
  <body name="walker_thigh_left" mocap="true"><geom size="0.05"/></body>
  <body name="walker_shank_left" mocap="true"><geom size="0.05"/></body>
  <body name="walker_thigh_right" mocap="true"><geom size="0.05"/></body>
  <body name="walker_shank_right" mocap="true"><geom size="0.05"/></body>
  <body name="cart" mocap="true" pos="0 5 0.5"><geom size="0.1"/></body>)";

struct Traffic : SmallWorld {
  explicit Traffic(const std::string& more = "", const std::string& asset = "") : SmallWorld(kTraffic + more, asset) {}

  Eigen::Vector3d place_of(const char* name) const {
    return Eigen::Vector3d(data->mocap_pos + 3 * model->body_mocapid[mj_name2id(model.get(), mjOBJ_BODY, name)]);
  }
  Eigen::Quaterniond rotation_of(const char* name) const {
    const mjtNum* q = data->mocap_quat + 4 * model->body_mocapid[mj_name2id(model.get(), mjOBJ_BODY, name)];
    return {q[0], q[1], q[2], q[3]};
  }
  /// Position of the lower end of a shank.
  Eigen::Vector3d foot(const char* shank) const {
    return place_of(shank) + rotation_of(shank) * Eigen::Vector3d(0, 0, -0.43);
  }
};

ActorSettings walker(std::vector<WaypointSettings> path) { return {.name = "walker", .path = std::move(path)}; }

/// Calls `look` at every tick of `seconds`. The robot keeps its velocity.
void run(Traffic& traffic, const ActorSettings& settings, double seconds, const std::function<void(double)>& look,
         ObservedRobot robot = kFarAway) {
  Actors actors(*traffic.model, {settings});
  for (Time now{}; now <= from_seconds(seconds); now += kTick) {
    actors.advance(now, robot, *traffic.data);
    robot.p_world += to_seconds(kTick) * robot.v_world_mps;
    look(to_seconds(now));
  }
}

TEST(ActorPath, ARightAngleOf3And4MetresIs7MetresLongAndTurnsSmoothlyOver0_8Metres) {
  const ActorPath path({{.x_m = 0, .y_m = 0}, {.x_m = 3, .y_m = 0}, {.x_m = 3, .y_m = 4}});
  EXPECT_DOUBLE_EQ(path.length_m(), 7.0);
  EXPECT_EQ(path.position(5.0), Eigen::Vector2d(3, 2));
  EXPECT_EQ(path.position(9.0), Eigen::Vector2d(3, 4));
  EXPECT_NEAR(path.heading_rad(2.5), 0.0, 1e-12);
  EXPECT_NEAR(path.heading_rad(3.0), kPi / 4.0, 1e-12);
  EXPECT_NEAR(path.heading_rad(3.5), kPi / 2.0, 1e-12);
}

TEST(Actors, APedestrianReaches1_2MetresPerSecondAt1_5MetresPerSquareSecondAndKeepsIt) {
  Traffic traffic;
  run(traffic, walker({{.x_m = 0, .y_m = 0}, {.x_m = 9, .y_m = 0}}), 6.0, [&](double now) {
    const double ramp = 1.2 / 1.5;
    const double expected = now < ramp ? 0.75 * now * now : 1.2 * (now - ramp / 2.0);
    EXPECT_NEAR(traffic.place_of("walker").x(), expected, 0.003) << now;
  });
}

TEST(Actors, TheFootThatStandsStaysWhereItIsAndOneFootAlwaysStands) {
  Traffic traffic;
  Eigen::Vector3d last[2];
  bool is_first = true;
  int changes = 0;  // ticks at which the feet take turns
  const char* const shanks[2] = {"walker_shank_left", "walker_shank_right"};
  run(traffic, walker({{.x_m = 0, .y_m = 0}, {.x_m = 9, .y_m = 0}}), 6.0, [&](double now) {
    const Eigen::Vector3d feet[2] = {traffic.foot(shanks[0]), traffic.foot(shanks[1])};
    if (!is_first && now > 1.0) {
      const double moved = std::min((feet[0] - last[0]).norm(), (feet[1] - last[1]).norm());
      changes += moved > 1e-6;
      EXPECT_LT(moved, 0.003) << now;                                       // a swinging foot goes as far in a tick
      EXPECT_NEAR(std::min(feet[0].z(), feet[1].z()), 0.012, 1e-6) << now;  // the ankle's height with the hip at 0.86 m
    }
    last[0] = feet[0], last[1] = feet[1];
    is_first = false;
  });
  EXPECT_LE(changes, 10);  // 6 m at 0.65 m a step
}

TEST(Actors, TheHipBobs6CentimetresOverAStepOf65) {
  Traffic traffic;
  test::Moments height;
  run(traffic, walker({{.x_m = 0, .y_m = 0}, {.x_m = 9, .y_m = 0}}), 4.0, [&](double now) {
    if (now > 1.0) height.add(traffic.place_of("walker").z());
  });
  EXPECT_NEAR(height.largest, 0.86, 1e-4);
  EXPECT_NEAR(height.largest - height.smallest, 0.848 - std::sqrt(0.848 * 0.848 - 0.325 * 0.325), 1e-4);
}

TEST(Actors, KneesJoinThighAndShank) {
  Traffic traffic;
  run(traffic, walker({{.x_m = 0, .y_m = 0}, {.x_m = 6, .y_m = 3}}), 4.0, [&](double now) {
    const Eigen::Vector3d knee =
        traffic.place_of("walker_thigh_left") + traffic.rotation_of("walker_thigh_left") * Eigen::Vector3d(0, 0, -0.43);
    EXPECT_NEAR((knee - traffic.place_of("walker_shank_left")).norm(), 0.0, 1e-9) << now;
  });
}

TEST(Actors, TheHipRises10CentimetresOntoThePavementWithoutAJump) {
  Traffic traffic;
  test::Moments before, after;
  double last = 0.86, highest_step = 0.0;
  run(traffic, walker({{.x_m = 7, .y_m = 0}, {.x_m = 13, .y_m = 0}}), 4.5, [&](double) {
    const Eigen::Vector3d hip = traffic.place_of("walker");
    highest_step = std::max(highest_step, hip.z() - last);
    last = hip.z();
    if (hip.x() < 9.7) before.add(hip.z());
    if (hip.x() > 10.3) after.add(hip.z());
  });
  EXPECT_NEAR(after.largest - before.largest, 0.10, 1e-6);
  EXPECT_LT(highest_step, 0.035);
}

TEST(Actors, AWalkerClimbsARampOfGroundToADeckHigherThanTheKnee) {
  // A height field 3 m long rises evenly to 0.8 m, where a deck carries on. The lidar sees it, as in a tunnel.
  Traffic traffic(R"(<geom type="hfield" hfield="ramp" pos="-6.5 -10 0" group="2"/>
                     <geom type="box" pos="-3 -10 0.4" size="2 1 0.4"/>)",
                  R"(<hfield name="ramp" nrow="2" ncol="2" size="1.5 1 0.8 0.1" elevation="0 1 0 1"/>)");
  test::Moments before, after;
  run(traffic, walker({{.x_m = -12, .y_m = -10}, {.x_m = -2, .y_m = -10}}), 10.0, [&](double now) {
    const Eigen::Vector3d hip = traffic.place_of("walker");
    if (now > 1.0 && hip.x() < -8.5) before.add(hip.z());
    if (hip.x() > -4.5 && hip.x() < -2.5) after.add(hip.z());
  });
  EXPECT_NEAR(after.largest - before.largest, 0.8, 1e-3);
}

TEST(Actors, ALoopGoesThereAndBackAgainAndTurnsRound) {
  Traffic traffic;
  double farthest = 0.0;
  run(traffic, walker({{.x_m = 0, .y_m = 0}, {.x_m = 3, .y_m = 0}}), 5.0,
      [&](double) { farthest = std::max(farthest, traffic.place_of("walker").x()); });
  EXPECT_NEAR(farthest, 3.0, 0.005);
  EXPECT_NEAR(traffic.place_of("walker").x(), 6.0 - 1.2 * (5.0 - 0.4), 0.01);
  EXPECT_NEAR((traffic.rotation_of("walker") * Eigen::Vector3d::UnitX()).x(), -1.0, 1e-9);
}

TEST(Actors, StartsAtItsTimeAndWithoutALoopStopsAtTheEnd) {
  Traffic traffic;
  ActorSettings settings = walker({{.x_m = 0, .y_m = 0}, {.x_m = 2, .y_m = 0}});
  settings.start_s = 1.0;
  settings.loop = false;
  run(traffic, settings, 6.0, [&](double now) {
    if (now < 1.0) {
      EXPECT_EQ(traffic.place_of("walker").x(), 0.0);
    }
  });
  EXPECT_EQ(traffic.place_of("walker").x(), 2.0);
}

TEST(Actors, WaitsForARobotInItsWayAndNotForOneBesideIt) {
  Traffic traffic;
  const ActorSettings settings = walker({{.x_m = 0, .y_m = 0}, {.x_m = 9, .y_m = 0}});
  run(traffic, settings, 6.0, [](double) {}, {.p_world = {4.0, 0.0}, .radius_m = 0.4});
  EXPECT_LT(traffic.place_of("walker").x(), 4.0 - 1.5);
  EXPECT_GT(traffic.place_of("walker").x(), 4.0 - 1.5 - 0.5);
  run(traffic, settings, 6.0, [](double) {}, {.p_world = {4.0, 1.5}, .radius_m = 0.4});
  EXPECT_GT(traffic.place_of("walker").x(), 6.0);
}

// A metre long and at a metre per second, from the side, at every time of crossing: never nearer than its outline and a
// shoulder.
TEST(Actors, ARobotThatCrossesAtOneMetrePerSecondIsNeverTouched) {
  for (double from_m = -10.0; from_m <= 1.0; from_m += 0.25) {
    for (const double side : {-1.0, 1.0}) {
      Traffic traffic;
      ObservedRobot robot{.p_world = {4.0, side * from_m}, .v_world_mps = {0.0, side}, .radius_m = 0.6};
      const Eigen::Vector2d start = robot.p_world, velocity = robot.v_world_mps;
      double nearest_m = 100.0;
      run(
          traffic, walker({{.x_m = 0, .y_m = 0}, {.x_m = 30, .y_m = 0}}), 14.0,
          [&](double now_s) {
            const Eigen::Vector2d p_robot = start + now_s * velocity;
            nearest_m = std::min(nearest_m, (traffic.place_of("walker").head<2>() - p_robot).norm());
          },
          robot);
      EXPECT_GT(nearest_m, 0.6 + 0.3) << "from " << start.transpose();
      EXPECT_GT(traffic.place_of("walker").x(), 5.0) << "walks on when it has passed";
    }
  }
}

TEST(Actors, ACarKeepsTheHeightAtWhichTheWorldPutsItAndLooksAlongItsWay) {
  Traffic traffic;
  run(traffic, {.name = "cart", .kind = "car", .path = {{.x_m = 0, .y_m = 5}, {.x_m = 0, .y_m = 9}}, .speed_mps = 2.0},
      1.5, [&](double) { EXPECT_NEAR(traffic.place_of("cart").z(), 0.5, 1e-9); });
  EXPECT_NEAR((traffic.rotation_of("cart") * Eigen::Vector3d::UnitX()).y(), 1.0, 1e-9);
}

TEST(Actors, OneTheWorldLacksIsRefusedAndTheKnownOnesAreNamed) {
  const Traffic traffic(R"(<body mocap="true" pos="0 9 1"><geom size="0.1"/></body>)");
  try {
    Actors(*traffic.model, {{.name = "dog", .path = {{.x_m = 0, .y_m = 0}, {.x_m = 1, .y_m = 0}}}});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("dog"));
    EXPECT_THAT(error.what(), testing::HasSubstr("known: walker, cart"));
  }
}

TEST(Actors, APathOfOnePointOrNoLengthIsRefused) {
  const Traffic traffic;
  EXPECT_THROW(Actors(*traffic.model, {walker({{.x_m = 0, .y_m = 0}})}), InputError);
  EXPECT_THROW(Actors(*traffic.model, {walker({{.x_m = 1, .y_m = 0}, {.x_m = 1, .y_m = 0}})}), InputError);
}

}  // namespace
}  // namespace patrol::sim::actors_test
