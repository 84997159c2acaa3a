#include "sim/simulator/simulator.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "io/urdf.h"
#include "tests/sim/rubble.h"
#include "tests/support/simulated_quadruped.h"
#include "tests/support/simulated_tracked_robot.h"
#include "tests/support/temporary_file.h"

namespace patrol::sim::simulator_test {
namespace {

/// A simulator of a robot in a small world, with no sensor but those that its firmware reads.
class SmallSimulation {
 public:
  SmallSimulation(const std::string& urdf, const std::string& world, const SimulatorSettings& settings = {})
      : file_("world.xml", world), simulator_(make(urdf, settings)) {}

  Simulator& operator*() { return simulator_; }
  Simulator* operator->() { return &simulator_; }

  /// Messages that were delivered meanwhile.
  std::vector<SensorMessage> run(double vx_mps, double duration_s) {
    simulator_.set_command({.stamp = {}, .vx_mps = vx_mps, .vy_mps = 0.0, .yaw_rate_radps = 0.0});
    std::vector<SensorMessage> all;
    for (const Time end = simulator_.now() + from_seconds(duration_s); simulator_.now() < end;) {
      simulator_.step();
      for (SensorMessage& message : simulator_.take_messages()) all.push_back(std::move(message));
    }
    return all;
  }

 private:
  Simulator make(const std::string& urdf, SimulatorSettings settings) const {
    settings.world_xml = file_.path();
    settings.robot_urdf = urdf;
    settings.sensors.lidar.enabled = settings.sensors.tdlas.enabled = settings.sensors.gnss.enabled = false;
    return Simulator(settings, io::load_robot_description(urdf), 1);
  }

  test::TemporaryFile file_;
  Simulator simulator_;
};

template <typename Message>
std::ptrdiff_t count(const std::vector<SensorMessage>& messages) {
  return std::count_if(messages.begin(), messages.end(),
                       [](const SensorMessage& message) { return std::holds_alternative<Message>(message); });
}

TEST(Simulator, ATrackedRobotSends50TicksASecondAndNothingOfLegs) {
  SmallSimulation simulator(kTrackedUrdf, make_flat_world());
  const auto messages = simulator.run(0.5, 2.0);
  EXPECT_NEAR(static_cast<double>(count<TrackTicks>(messages)), 100.0, 1.0);
  EXPECT_EQ(count<JointState>(messages), 0);
  EXPECT_EQ(count<FootContacts>(messages), 0);
  EXPECT_GT(count<Imu>(messages), 0);
  EXPECT_NEAR(simulator->truth().T_world_body.position.x(), 0.5 * (2.0 - 0.3), 0.1);
}

TEST(Simulator, ARobotOnLegsSendsNoTicks) {
  SmallSimulation simulator(kRobotUrdf, make_flat_world());
  EXPECT_EQ(count<TrackTicks>(simulator.run(0.0, 0.2)), 0);
}

TEST(Simulator, ARefusedStartIsTheGivenOneUnlessOnlyItsPlacementErrorIsInvalid) {
  const auto error_at = [](double x_m) {
    SimulatorSettings settings;
    settings.T_world_start = {x_m, 0.0, 0.0};
    settings.as_built.enabled = true;
    settings.as_built.placement.position_m = 0.2;
    try {
      SmallSimulation(kTrackedUrdf, make_flat_world(R"(<geom name="wall" type="box" pos="9 0 1" size="2 2 1"/>
          <geom name="front" type="box" pos="1.52 0 1" size="1 2 1"/><geom name="back" type="box" pos="-1.52 0 1" size="1 2 1"/>
          <geom name="left" type="box" pos="0 1.4 1" size="0.5 1 1"/><geom name="right" type="box" pos="0 -1.4 1" size="0.5 1 1"/>)"),
                      settings);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(error_at(9.0), "start pose (9.00, 0.00): in collision with wall");
  EXPECT_THAT(error_at(0.0), ::testing::EndsWith(": with the error of as_built.placement; (0.00, 0.00) without it is "
                                                 "valid"));
}

TEST(Simulator, ControlThatIsNotFiniteEndsTheSimulationWithAnError) {
  const std::string too_slow = R"(<mujoco><option timestep="0.01"/><worldbody>
      <geom type="plane" size="20 20 0.1" conaffinity="2"/></worldbody></mujoco>)";
  mju_user_warning = [](const char*) {};  // otherwise MuJoCo writes a file
  SmallSimulation simulator(PATROL_SOURCE_DIR "/models/wheeled/wheeled.urdf", too_slow);
  try {
    simulator.run(0.5, 5.0);
    ADD_FAILURE() << "the simulation goes on";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), ::testing::MatchesRegex("physics diverged at .* s: a motor command is not finite or too "
                                                      "large \\(time step 0.01 s\\)"));
  }
  mju_user_warning = nullptr;
}

TEST(Simulator, LiftedToAnotherPlaceEitherRobotStandsThereUprightAndItsCountersKnowNothingOfIt) {
  for (const std::string& urdf : {kTrackedUrdf, kRobotUrdf}) {
    SmallSimulation simulator(
        urdf, make_flat_world(R"(<geom name="ground_stage" type="box" pos="6 2 0.1" size="1 1 0.1"/>)"));
    simulator.run(0.4, 2.0);
    const SimState before = simulator->state();
    simulator->teleport({6.0, 2.0, 2.0});
    const SimState after = simulator->state();
    if (urdf == kTrackedUrdf) {
      EXPECT_TRUE(std::equal(before.qpos.begin() + 7, before.qpos.end(), after.qpos.begin() + 7))
          << "belts and springs";
    }
    const GroundTruth at_once = simulator->truth();
    EXPECT_NEAR(at_once.T_world_body.position.x(), 6.0, 1e-9);
    EXPECT_NEAR(to_yaw(at_once.T_world_body.rotation), 2.0, 1e-9);
    EXPECT_EQ(at_once.twist.linear.norm(), 0.0);
    simulator.run(0.0, 3.0);
    const Pose3 later = simulator->truth().T_world_body;
    EXPECT_LT((later.position - Eigen::Vector3d(6.0, 2.0, later.position.z())).norm(), 0.1) << urdf;
    EXPECT_GT(later.position.z(), 0.2 + 0.1) << "on the stage of 0.2 m";
    EXPECT_FALSE(simulator->has_fallen()) << urdf;
  }
}

// Four standard deviations of the tilt that is left (19") are 1.5 mm at 4 m.
TEST(Simulator, AScanOfTheTrackedRobotOnFlatGroundHasTheFloor85CentimetresBelowItAndTheRobotStandsStill) {
  SimulatorSettings settings;
  settings.sensors.scanner.enabled = true;
  settings.sensors.scanner.step_deg = 2.0;
  settings.sensors.scanner.duration_s = 5.0;
  SmallSimulation simulator(kTrackedUrdf, make_flat_world(), settings);
  simulator.run(0.0, 4.0);  // its springs come to rest
  EXPECT_FALSE(simulator->is_busy());
  const Pose3 before = simulator->truth().T_world_body;
  simulator->command(ScanCommand{simulator->now()});
  EXPECT_TRUE(simulator->is_busy());
  const auto messages = simulator.run(0.0, 5.6);
  EXPECT_FALSE(simulator->is_busy());
  EXPECT_LT((simulator->truth().T_world_body.position - before.position).norm(), 0.5e-3);
  ASSERT_EQ(count<PanoramicScan>(messages), 1);
  const auto is_scan = [](const SensorMessage& message) { return std::holds_alternative<PanoramicScan>(message); };
  const auto& scan = std::get<PanoramicScan>(*std::find_if(messages.begin(), messages.end(), is_scan));
  const double height_m = (before * io::load_robot_description(kTrackedUrdf).T_body("scanner").position).z();
  EXPECT_NEAR(height_m, 0.85, 0.01);
  int floor = 0, robot = 0;
  for (const ScannerPoint& point : scan.points) {
    const bool is_over_robot = point.x > -0.3F && point.x < 1.0F && std::abs(point.y) < 0.4F;
    if (is_over_robot || std::hypot(point.x, point.y) > 4.0F) {
      robot += is_over_robot && point.z > -0.8F;
    } else {
      EXPECT_NEAR(point.z, -height_m, 0.003) << point.x << ", " << point.y;
      ++floor;
    }
  }
  EXPECT_GT(floor, 2000);
  EXPECT_GT(robot, 10);
}

TEST(Simulator, OnRoughGroundARobotThatCreepsStandsWithin5MicrometresAndAThousandthOfADegreeOverAScan) {
  SimulatorSettings settings;
  settings.sensors.scanner.enabled = true;
  settings.sensors.scanner.step_deg = 10.0;
  SmallSimulation simulator(kTrackedUrdf, make_rubble_world(16.0, 6.0, 0.006, 0.003), settings);
  simulator.run(0.0, 4.0);
  const auto creep_of = [&](double duration_s) {
    const Pose3 before = simulator->truth().T_world_body;
    simulator.run(0.0, duration_s);
    const Pose3 after = simulator->truth().T_world_body;
    return std::pair((after.position - before.position).norm(),
                     to_deg(before.rotation.angularDistance(after.rotation)));
  };
  const auto [free_m, free_deg] = creep_of(29.0);
  simulator->command(ScanCommand{simulator->now()});
  const auto [held_m, held_deg] = creep_of(29.0);
  EXPECT_TRUE(simulator->is_busy());
  EXPECT_LT(held_m, 5e-6);
  EXPECT_LT(held_deg, 0.001);
  EXPECT_GT(free_m, 10.0 * held_m) << "the soft contact lets it creep, or there is nothing to be held";
}

TEST(Simulator, RingsOfAWorldWithoutALiningCannotBeMoved) {
  SimulatorSettings settings;
  settings.lining_deformations = {{.kind = "settlement", .first_ring = 2, .last_ring = 2, .inward_mm = 6.0}};
  EXPECT_THAT(
      [&] { SmallSimulation(kTrackedUrdf, make_flat_world(), settings); },
      testing::ThrowsMessage<InputError>("lining_deformation.0.first_ring = 2: requires a lining in the mission file"));
}

std::string kerb(double x_m, double height_m, double half_length_m = 0.09) {
  return fmt::format(R"(<geom name="kerb_0" type="box" pos="{} 0 {}" size="{} 3 0.2"/>)", x_m + half_length_m,
                     height_m - 0.2, half_length_m);
}

// The tunnel's stones are 22 cm high.
TEST(Simulator, ADriveAgainstTheSideOfACurbStoneThatIsHigherThanAStreetsIsACollision) {
  for (const std::string& urdf : {kTrackedUrdf, kRobotUrdf}) {
    for (const double height_m : {0.17, 0.22, 0.3}) {
      SmallSimulation simulator(urdf, make_flat_world(kerb(1.0, height_m)));
      simulator.run(0.4, 4.0);
      const auto collisions = simulator->take_collisions();
      ASSERT_FALSE(collisions.empty()) << urdf << ", " << height_m << " m";
      EXPECT_EQ(collisions[0].second, "kerb_0");
    }
  }
}

TEST(Simulator, WalkingAndDrivingOverALowCurbStoneIsNone) {
  for (const std::string& urdf : {kTrackedUrdf, kRobotUrdf}) {
    for (const double height_m : {0.05, 0.12}) {
      SmallSimulation simulator(urdf, make_flat_world(kerb(1.0, height_m, 5.0)));
      simulator.run(0.4, 5.0);
      EXPECT_THAT(simulator->take_collisions(), testing::IsEmpty()) << urdf << ", " << height_m << " m";
      if (height_m < 0.1) {
        EXPECT_GT(simulator->truth().T_world_body.position.x(), 1.2) << urdf << ": it went over";
      }
    }
  }
}

TEST(Simulator, StandingAndDrivingOnTopOfAHighCurbStoneIsNone) {
  for (const std::string& urdf : {kTrackedUrdf, kRobotUrdf}) {
    SmallSimulation simulator(urdf, make_flat_world(kerb(2.0, 0.22, 5.0)));
    simulator->teleport({5.0, 0.0, 0.0});
    simulator.run(0.4, 2.0);
    EXPECT_THAT(simulator->take_collisions(), testing::IsEmpty()) << urdf;
  }
}

TEST(Simulator, PutDownOnRubbleItDrivesOn) {
  SmallSimulation simulator(kTrackedUrdf, make_rubble_world(16.0, 6.0));
  simulator.run(0.5, 1.0);
  simulator->teleport({-6.0, 1.0, 0.0});
  simulator.run(0.5, 4.0);
  EXPECT_NEAR(simulator->truth().T_world_body.position.x(), -6.0 + 0.5 * 3.7, 0.2);
}

TEST(Simulator, WhereThereIsNoGroundItCannotBePut) {
  SmallSimulation simulator(kTrackedUrdf, make_rubble_world(4.0, 4.0));
  EXPECT_THAT(
      [&] {
        simulator->teleport({50.0, 0.0, 0.0});
      },
      testing::ThrowsMessage<InputError>(testing::HasSubstr("(50.00, 0.00): no ground below")));
}

/// Drives 2 m on level ground with drawn sprockets only: the robot covers their mean relative radius more, while the
/// counters say the same.
TEST(AsBuilt, LargerSprocketsDriveFartherThanTheCountersSay) {
  const auto odometer_ratio = [](const AsBuiltSettings& as_built) {
    SimulatorSettings settings;
    settings.as_built = as_built;
    SmallSimulation simulation(kTrackedUrdf, make_flat_world(), settings);
    simulation.run(0.0, 1.0);
    const double from_m = simulation->truth().T_world_body.position.x();
    const auto ticks = [&](const std::vector<SensorMessage>& messages) {
      double sum = 0.0;
      for (const SensorMessage& message : messages) {
        if (const auto* counts = std::get_if<TrackTicks>(&message)) {
          sum = 0.5 * static_cast<double>(counts->left + counts->right);
        }
      }
      return sum;
    };
    const double counted = ticks(simulation.run(0.5, 5.0));
    return (simulation->truth().T_world_body.position.x() - from_m) / counted;
  };
  AsBuiltSettings as_built;
  as_built.enabled = true;
  as_built.mounting = {.position_m = 0.0, .angle_deg = 0.0};
  as_built.imu = {.gyro_bias_std_radps = 0.0, .accel_bias_std_mps2 = 0.0, .scale_std = 0.0};
  as_built.clock = {.offset_s = 0.0, .drift_ppm = 0.0, .transport_jitter_s = 0.0};
  as_built.placement = {.position_m = 0.0, .yaw_deg = 0.0};
  as_built.tracks = {.sprocket_scale = 0.05, .friction_scale = 0.0, .missed_edge_probability = 0.0};
  const TrackErrors errors = AsBuiltRobot(as_built, io::load_robot_description(kTrackedUrdf), 1).tracks();
  const double mean_scale = 0.5 * (errors.sprocket_scale[0] + errors.sprocket_scale[1]);
  ASSERT_GT(std::abs(mean_scale - 1.0), 0.003);
  EXPECT_NEAR(odometer_ratio(as_built) / odometer_ratio({}), mean_scale, 0.002);
}

TEST(AsBuilt, PlacementMovesTheStartAndNothingIsDrawnForANominalRobot) {
  SimulatorSettings settings;
  SmallSimulation nominal(kTrackedUrdf, make_flat_world(), settings);
  EXPECT_TRUE(nominal->as_built().values.empty());
  EXPECT_EQ(nominal->truth().T_world_body.position.x(), 0.0);
  settings.as_built.enabled = true;
  SmallSimulation actual(kTrackedUrdf, make_flat_world(), settings);
  std::map<std::string, double> values;
  for (const auto& [name, value] : actual->as_built().values) values[name] = value;
  EXPECT_NEAR(actual->truth().T_world_body.position.x(), values.at("placement.x_m"), 1e-12);
  EXPECT_NEAR(to_yaw(actual->truth().T_world_body.rotation), values.at("placement.yaw_rad"), 1e-12);
  EXPECT_NE(values.at("placement.x_m"), 0.0);
}

/// An accelerometer bias of 0.53 m/s2 across the robot tilts its vertical by 3.1 degrees.
TEST(AsBuilt, QuadrupedWalksUprightDespiteAnAccelerometerBiasAcrossIt) {
  SimulatorSettings settings;
  settings.as_built.enabled = true;
  settings.as_built.mounting = {.position_m = 0.0, .angle_deg = 0.0};
  settings.as_built.joint_encoders = {.zero_offset_deg = 0.0, .play_deg = 0.0};
  settings.as_built.legs = {.friction_scale = 0.0};
  settings.as_built.imu = {.gyro_bias_std_radps = 0.0, .scale_std = 0.0, .misalignment_std_deg = 0.0};
  ASSERT_NEAR(AsBuiltRobot(settings.as_built, io::load_robot_description(kRobotUrdf), 1).imu().accel.bias.y(), 0.531,
              0.001);
  SmallSimulation simulation(kRobotUrdf, make_flat_world(), settings);
  simulation.run(0.0, 1.0);
  simulation.run(0.8, 5.0);
  double sum_deg = 0.0;
  constexpr int kTicks = 5000;
  for (int tick = 0; tick < kTicks; ++tick) {
    simulation->step();
    const Eigen::Vector3d left = simulation->truth().T_world_body.rotation * Eigen::Vector3d::UnitY();
    sum_deg += to_deg(std::asin(left.z()));
  }
  EXPECT_FALSE(simulation->has_fallen());
  EXPECT_NEAR(sum_deg / kTicks, 0.0, 5.0);
}

}  // namespace
}  // namespace patrol::sim::simulator_test
