#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/state/message_state.h"
#include "io/urdf.h"
#include "sim/simulator/simulator.h"
#include "tests/support/simulated_quadruped.h"
#include "tests/support/simulated_tracked_robot.h"
#include "tests/support/temporary_file.h"

namespace patrol::sim::simulator_state_test {
namespace {

const std::string kBoxes = R"(
  <geom name="wall_0" type="box" pos="4 0 1" size="0.1 3 1"/>
  <geom name="step_0" type="box" pos="1.2 0 0.02" size="0.3 0.5 0.02"/>
  <body name="pedestrian_1" mocap="true" pos="2 2 0.9">
    <geom name="trunk_1" type="capsule" size="0.2 0.5"/>
  </body>)";

SimulatorSettings settings_of(const std::string& urdf, const std::string& world) {
  const auto has = [robot = io::load_robot_description(urdf)](const char* frame) {
    return robot.T_body_sensor.contains(frame);
  };
  SimulatorSettings settings;
  settings.sensors.tdlas.enabled = has("tdlas");
  settings.sensors.lidar.enabled = has("lidar");
  settings.sensors.scanner.enabled = has("scanner");
  settings.sensors.uwb.enabled = false;
  settings.world_xml = world;
  settings.robot_urdf = urdf;
  settings.sensors.gnss.enabled = false;
  settings.actors = {{.name = "pedestrian_1", .path = {{2.0, 2.0}, {2.0, -2.0}}, .speed_mps = 1.0}};
  settings.faults = {{.sensor = "imu", .kind = "outliers", .start_s = 0.5, .duration_s = 5.0, .magnitude = 0.01},
                     {.sensor = "lidar", .kind = "jitter", .start_s = 0.2, .duration_s = 5.0, .magnitude = 0.01}};
  settings.as_built.enabled = true;
  return settings;
}

std::string state_of(Simulator& simulator) {
  StateArchive archive;
  simulator.serialize_state(archive);
  return archive.bytes();
}

/// State without what MuJoCo leaves uninitialized.
std::string comparable_state_of(Simulator& simulator) {
  StateArchive archive = StateArchive::for_comparison();
  simulator.serialize_state(archive);
  return archive.bytes();
}

/// All messages, truths and collisions of a drive, as bytes.
std::string drive(Simulator& simulator, int num_ticks) {
  StateArchive archive;
  for (int tick = 0; tick < num_ticks; ++tick) {
    simulator.set_command({.stamp = simulator.now(), .vx_mps = 0.4, .yaw_rate_radps = 0.2});
    simulator.step();
    auto messages = simulator.take_messages();
    auto collisions = simulator.take_collisions();
    auto truth = simulator.truth();
    archive(messages, collisions, truth);
  }
  return archive.bytes();
}

/// Describes the first byte of two states that differs: the last section before it and the distance; empty if equal.
std::string difference(const std::string& a, const std::string& b) {
  if (a == b) return "";
  const auto at = static_cast<std::size_t>(
      std::mismatch(a.begin(), a.begin() + std::min(a.size(), b.size()), b.begin()).first - a.begin());
  std::string section = "start";
  std::size_t begin = 0;
  for (const char* name : {"simulator", "model", "physics", "sensors"}) {
    const std::size_t found = a.rfind(name, at);
    if (found != std::string::npos && found >= begin) begin = found, section = name;
  }
  return fmt::format("{} + {} of {} and {} bytes", section, at - begin, a.size(), b.size());
}

class RestoredSimulator : public testing::TestWithParam<std::string> {};

// The state is saved in the air, on the step, and at the wall.
TEST_P(RestoredSimulator, ContinuesWithTheSameBytes) {
  const std::string urdf = PATROL_SOURCE_DIR "/models/" + GetParam() + "/" + GetParam() + ".urdf";
  const test::TemporaryFile world("world.xml", make_flat_world(kBoxes));
  const SimulatorSettings settings = settings_of(urdf, world.path());
  const RobotDescription robot = io::load_robot_description(urdf);
  Simulator simulator(settings, robot, 1);
  for (const int num_ticks : {1, 150, 700}) {
    drive(simulator, num_ticks);
    const std::string state = state_of(simulator);
    Simulator other(settings, robot, 1);
    StateArchive archive(state);
    other.serialize_state(archive);
    EXPECT_TRUE(archive.is_at_end());
    EXPECT_EQ(difference(state_of(other), state), "") << "restored at " << to_seconds(simulator.now()) << " s";
    EXPECT_TRUE(drive(other, 400) == drive(simulator, 400)) << "after " << to_seconds(simulator.now()) << " s";
    EXPECT_EQ(difference(comparable_state_of(other), comparable_state_of(simulator)), "");
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, RestoredSimulator, testing::Values("quadruped", "tracked", "wheeled", "cart"),
                         [](const auto& robot) { return robot.param; });

TEST(SimulatorState, SavingChangesNothing) {
  const test::TemporaryFile world("world.xml", make_flat_world(kBoxes));
  const SimulatorSettings settings = settings_of(kTrackedUrdf, world.path());
  const RobotDescription robot = io::load_robot_description(kTrackedUrdf);
  Simulator saved(settings, robot, 1), other(settings, robot, 1);
  for (int i = 0; i < 10; ++i) {
    state_of(saved);
    ASSERT_TRUE(drive(saved, 40) == drive(other, 40));
  }
}

TEST(SimulatorState, TheStateOfAnotherWorldIsRefused) {
  const test::TemporaryFile world("world.xml", make_flat_world(kBoxes)), empty("empty.xml", make_flat_world());
  const RobotDescription robot = io::load_robot_description(kTrackedUrdf);
  Simulator simulator(settings_of(kTrackedUrdf, world.path()), robot, 1);
  SimulatorSettings without = settings_of(kTrackedUrdf, empty.path());
  without.actors.clear();
  Simulator other(without, robot, 1);
  StateArchive archive(state_of(simulator));
  EXPECT_THROW(other.serialize_state(archive), std::runtime_error);
}

}  // namespace
}  // namespace patrol::sim::simulator_state_test
