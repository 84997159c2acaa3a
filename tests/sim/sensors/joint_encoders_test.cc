#include "sim/sensors/joint_encoders.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/sim/small_world.h"

namespace patrol::sim::joint_encoders_test {
namespace {

const std::string kElbow = R"(<body><joint name="other" axis="0 1 0"/><geom size="0.1"/>
  <body><joint name="elbow" axis="0 1 0"/><geom size="0.1"/></body></body>)";
constexpr double kStep_rad = 2.0 * std::numbers::pi / 16384;

TEST(JointEncoders, ReadWholeCountsOf16384WithAnErrorSpreadEvenlyOverOne) {
  SmallWorld world(kElbow);
  JointEncoders encoders({}, *world.model, {"elbow"});
  test::Moments error;
  for (int i = 0; i < 20000; ++i) {
    world.data->qpos[1] = -1.0 + 1.00013e-4 * i;
    const double angle = encoders.read(*world.data, Time{}).position_rad[0];
    EXPECT_NEAR(std::remainder(angle, kStep_rad), 0.0, 1e-12);
    error.add(angle - world.data->qpos[1]);
  }
  EXPECT_LE(error.largest, kStep_rad / 2.0 + 1e-12);
  EXPECT_GE(error.smallest, -kStep_rad / 2.0 - 1e-12);
  EXPECT_NEAR(error.std(), kStep_rad / std::sqrt(12.0), 0.02 * kStep_rad);
}

TEST(JointEncoders, SpeedFollowsAStepByAFirstOrderFilterOf3Milliseconds) {
  SmallWorld world(kElbow);
  JointEncoderSettings settings;
  settings.counts_per_revolution = 1 << 24;
  JointEncoders encoders(settings, *world.model, {"elbow"});
  encoders.read(*world.data, Time{});
  for (int tick = 1; tick <= 20; ++tick) {
    world.data->qpos[1] = 5.0 * 0.002 * tick;  // 5 rad/s from rest
    const double expected = 5.0 * (1.0 - std::pow(0.003 / (0.003 + 0.002), tick));
    EXPECT_NEAR(encoders.read(*world.data, Time{}).velocity_radps[0], expected, 0.002) << tick;
  }
}

TEST(JointEncoders, OneCountOfJitterReadsAsMost0_1RadiansPerSecond) {
  SmallWorld world(kElbow);
  JointEncoders encoders({}, *world.model, {"elbow"});
  encoders.read(*world.data, Time{});
  test::Moments speed;
  for (int tick = 0; tick < 1000; ++tick) {
    world.data->qpos[1] = (tick % 2 == 0 ? 0.6 : 0.4) * kStep_rad;
    speed.add(std::abs(encoders.read(*world.data, Time{}).velocity_radps[0]));
  }
  // One count in a tick is 0.192 rad/s; the filter lets 0.4 of a step through.
  EXPECT_LT(speed.largest, 0.1);
}

TEST(JointEncoders, EffortIsTheActuatorsTorqueAndJointsComeInTheOrderAskedFor) {
  SmallWorld world(kElbow);
  world.data->qpos[0] = 0.25;
  world.data->qpos[1] = 0.75;
  world.data->qfrc_actuator[0] = 3.0;
  world.data->qfrc_actuator[1] = -7.0;
  const JointState state = JointEncoders({}, *world.model, {"elbow", "other"}).read(*world.data, from_seconds(1.5));
  EXPECT_EQ(state.stamp, from_seconds(1.5));
  EXPECT_NEAR(state.position_rad[0], 0.75, kStep_rad);
  EXPECT_NEAR(state.position_rad[1], 0.25, kStep_rad);
  EXPECT_EQ(state.effort_nm, (std::vector<double>{-7.0, 3.0}));
}

TEST(JointEncoders, AJointThatTheModelLacksIsRefused) {
  const SmallWorld world(kElbow);
  EXPECT_THROW(JointEncoders({}, *world.model, {"knee"}), InputError);
}

TEST(JointEncoders, ZeroOffsetShiftsTheReadingAndThePlayFollowsTheLoad) {
  SmallWorld world(kElbow);
  JointEncoderSettings settings;
  settings.counts_per_revolution = 1 << 24;
  JointEncoders encoders(settings, *world.model, {"elbow"}, {.zero_offset_rad = {0.005}, .play_rad = {0.002}});
  const int dof = 1;
  world.data->qpos[1] = 0.3;
  world.data->qfrc_actuator[dof] = 0.0;
  EXPECT_NEAR(encoders.read(*world.data, Time{}).position_rad[0], 0.305, 1e-6);
  world.data->qfrc_actuator[dof] = 8.0;
  EXPECT_NEAR(encoders.read(*world.data, Time{}).position_rad[0], 0.306, 1e-6);
  world.data->qfrc_actuator[dof] = -8.0;
  EXPECT_NEAR(encoders.read(*world.data, Time{}).position_rad[0], 0.304, 1e-6);
}

}  // namespace
}  // namespace patrol::sim::joint_encoders_test
