#include "sim/antenna_mount.h"

#include <cmath>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "sim/simulator/simulator.h"
#include "tests/support/simulated_quadruped.h"
#include "tests/support/simulated_tracked_robot.h"
#include "tests/support/temporary_file.h"

namespace patrol::sim::antenna_mount_test {
namespace {

SimulatorSettings settings_for(const test::TemporaryFile& world) {
  SimulatorSettings settings;
  settings.world_xml = world.path();
  settings.robot_urdf = kTrackedUrdf;
  settings.sensors.lidar.enabled = settings.sensors.tdlas.enabled = settings.sensors.gnss.enabled = false;
  settings.sensors.tem.enabled = true;
  return settings;
}

/// The tracked robot on level ground, its TEM switched on.
class AntennaOnTheRobot : public testing::Test {
 protected:
  AntennaOnTheRobot()
      : file_("world.xml", make_flat_world()), simulator_(settings_for(file_), tracked_description(), 1) {}

  void run(double duration_s) {
    for (const Time end = simulator_.now() + from_seconds(duration_s); simulator_.now() < end;) {
      const double before = joint("tem_yaw_joint");
      simulator_.step();
      fastest_radps_ = std::max(fastest_radps_, std::abs(joint("tem_yaw_joint") - before) / 0.002);
      for (const SensorMessage& message : simulator_.take_messages()) {
        if (const auto* state = std::get_if<AntennaState>(&message)) states_.push_back(*state);
        if (const auto* sounding = std::get_if<TemSounding>(&message)) sounding_ = *sounding;
      }
    }
  }
  void turn(double yaw_deg, double pitch_deg) {
    simulator_.command(
        AntennaCommand{.stamp = simulator_.now(), .yaw_rad = yaw_deg * kDegree, .pitch_rad = pitch_deg * kDegree});
  }
  /// The truth.
  double joint(const char* name) const {
    return simulator_.state().qpos[static_cast<std::size_t>(
        simulator_.physics().jnt_qposadr[mj_name2id(&simulator_.physics(), mjOBJ_JOINT, name)])];
  }

  test::TemporaryFile file_;
  Simulator simulator_;
  std::vector<AntennaState> states_;
  std::optional<TemSounding> sounding_;
  double fastest_radps_ = 0.0;
};

TEST_F(AntennaOnTheRobot, StaysStowedFlatWithinOneDegreeWhileTheRobotDrives) {
  simulator_.set_command({.stamp = {}, .vx_mps = 0.5, .vy_mps = 0.0, .yaw_rate_radps = 0.4});
  run(3.0);
  EXPECT_FALSE(simulator_.is_busy());
  EXPECT_NEAR(joint("tem_pitch_joint"), -90.0 * kDegree, 1.5 * kDegree);
  EXPECT_NEAR(joint("tem_yaw_joint"), 0.0, 1.5 * kDegree);
}

// The encoders' own error: 0.3 deg (1 sigma) of alignment, half of 0.33 deg of backlash, half a step of 0.088 deg.
TEST_F(AntennaOnTheRobot, TurnsWhereItIsToldByItsEncodersAndTrulyToTheirError) {
  turn(40.0, -15.0);
  run(4.0);
  EXPECT_TRUE(simulator_.is_busy());
  ASSERT_FALSE(states_.empty());
  EXPECT_NEAR(states_.back().yaw_rad, 40.0 * kDegree, 0.2 * kDegree);
  EXPECT_NEAR(states_.back().pitch_rad, -15.0 * kDegree, 0.2 * kDegree);
  EXPECT_NEAR(joint("tem_yaw_joint"), 40.0 * kDegree, (3.0 * 0.3 + 0.17 + 0.2) * kDegree);
  EXPECT_NEAR(joint("tem_pitch_joint"), -15.0 * kDegree, (3.0 * 0.3 + 0.17 + 0.2) * kDegree);
  EXPECT_NE(joint("tem_yaw_joint"), states_.back().yaw_rad);
  turn(0.0, -90.0);
  run(4.0);
  EXPECT_FALSE(simulator_.is_busy());
}

TEST_F(AntennaOnTheRobot, KeepsToOneRadianASecondAndToTheStopsOfTheMount) {
  turn(-200.0, 0.0);
  run(4.0);
  EXPECT_LT(fastest_radps_, 1.15);
  EXPECT_GT(fastest_radps_, 0.85);
  EXPECT_NEAR(joint("tem_yaw_joint"), -1.2, 0.03);
}

TEST_F(AntennaOnTheRobot, TellsItsAnglesTenTimesASecondInStepsOfTheEncoder) {
  turn(20.0, 0.0);
  run(3.0);
  EXPECT_NEAR(static_cast<double>(states_.size()), 30.0, 1.0);
  for (const AntennaState& state : states_) {
    const double steps = state.yaw_rad / (0.088 * kDegree);
    EXPECT_NEAR(steps, std::round(steps), 1e-6);
  }
}

TEST_F(AntennaOnTheRobot, ApproachedFromBothSidesItStandsApartByTheBacklash) {
  turn(0.0, 0.0);
  run(4.0);
  turn(20.0, 0.0);
  run(4.0);
  const double from_right = joint("tem_yaw_joint");
  turn(40.0, 0.0);
  run(4.0);
  turn(20.0, 0.0);
  run(4.0);
  EXPECT_NEAR(joint("tem_yaw_joint") - from_right, 0.33 * kDegree,
              0.2 * kDegree);  // dead band of 0.1 deg on both sides
}

TEST_F(AntennaOnTheRobot, ASoundingComesASecondAfterItIsAskedForAndTheRobotStaysWhereItIs) {
  run(1.0);
  const Eigen::Vector3d before = simulator_.truth().T_world_body.position;
  turn(60.0, 30.0);
  run(4.0);
  simulator_.command(SoundingCommand{.stamp = simulator_.now()});
  const Time asked = simulator_.now();
  run(0.5);
  EXPECT_FALSE(sounding_);
  EXPECT_TRUE(simulator_.is_busy());
  run(1.0);
  ASSERT_TRUE(sounding_);
  EXPECT_NEAR(to_seconds(sounding_->stamp - asked), 1.0, 0.005);
  EXPECT_LT((simulator_.truth().T_world_body.position - before).norm(), 0.002);
}

TEST(AntennaMount, RefusesAModelWithoutItsJointsAndASpeedOfNothing) {
  const ModelPtr empty = compile(*parse_spec("<mujoco/>"), "nothing");
  EXPECT_THROW(AntennaMount({}, {}, *empty, 1), InputError);
  AntennaSettings settings;
  settings.max_speed_radps = 0.0;
  try {
    AntennaMount(settings, {}, *empty, 1);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("sensors.antenna.max_speed_radps = 0"));
  }
}

}  // namespace
}  // namespace patrol::sim::antenna_mount_test
