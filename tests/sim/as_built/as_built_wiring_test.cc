// Each drawn error reaches the readings or the physics. The tests fail when a sensor is made with the nominal robot or
// when an error is dropped on its way to the sensor.

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "io/ros/ros_messages.h"
#include "io/urdf.h"
#include "sim/simulator/simulator.h"
#include "tests/sim/as_built/tolerances.h"
#include "tests/sim/lidar_scans.h"
#include "tests/support/simulated_quadruped.h"
#include "tests/support/simulated_tracked_robot.h"
#include "tests/support/simulated_wheeled_robot.h"
#include "tests/support/temporary_file.h"
#include "tests/support/wall_imager.h"

namespace patrol::sim::as_built_wiring_test {
namespace {

constexpr double kWall_m = 5.0;

/// Box with two sprockets at the origin, 1 m up, before a wall.
const std::string kWorld = box("5.5 0 0", "0.5 40 40") + R"(
    <body name="base_link" pos="0 0 1"><freejoint/><inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/><site name="imu"/>
      <body><joint name="left" axis="0 1 0"/><inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/></body>
      <body><joint name="right" axis="0 1 0"/><inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/></body></body>)";

RobotDescription make_carrier() {
  RobotDescription robot;
  robot.name = "carrier";
  robot.tracks = TrackGeometry{};
  robot.joint_names = {"left", "right"};
  robot.T_body_sensor["lidar"] = {{0.2, 0.0, 0.3}, Eigen::Quaterniond::Identity()};
  robot.T_body_sensor["depth_camera"] = {};
  return robot;
}

/// Sensors without noise: lidar, depth camera and Hall sensors.
SensorSuiteSettings without_noise() {
  SensorSuiteSettings settings;
  settings.lidar = ideal();
  settings.imu.enabled = settings.tdlas.enabled = settings.gnss.enabled = false;
  settings.hall.rate_hz = 500.0;
  settings.depth_camera.enabled = true;
  settings.depth_camera.depth_noise_std_per_m = settings.depth_camera.dropout_probability = 0.0;
  return settings;
}

/// Carrier of an as-built robot and its sensor suite. Nothing moves but what the test moves.
class Carrier {
 public:
  explicit Carrier(const AsBuiltSettings& as_built, std::uint64_t seed = 1)
      : robot_(as_built, make_carrier(), seed),
        world_(kWorld),
        suite_(without_noise(), robot_, *world_.model, *world_.model, GasPlume(Eigen::Vector3d::Zero(), 0.0, {}), {},
               seed, test::make_wall_imager) {}

  const AsBuiltRobot& robot() const { return robot_; }

  /// Turns both sprockets to an angle.
  void turn_sprockets_to(double angle_rad) {
    for (const char* joint : {"left", "right"}) {
      world_.data->qpos[world_.model->jnt_qposadr[mj_name2id(world_.model.get(), mjOBJ_JOINT, joint)]] = angle_rad;
    }
  }

  /// Returns the last message of a type over 0.3 s.
  template <typename Message>
  Message last() {
    std::vector<Message> found;
    for (const Time end = now_ + from_seconds(0.3); now_ <= end; now_ += kTick) {
      suite_.step(*world_.model, *world_.data, now_);
      for (SensorMessage& message : suite_.take_due(now_)) {
        if (auto* const content = std::get_if<Message>(&message)) found.push_back(std::move(*content));
      }
    }
    EXPECT_FALSE(found.empty());
    return found.empty() ? Message{} : found.back();
  }

 private:
  AsBuiltRobot robot_;
  SmallWorld world_;
  SensorSuite suite_;
  Time now_{};
};

/// A beam of direction d, in world, meets the wall at distance / d_x.
TEST(AsBuiltWiring, ALidarThatIsMountedTurnedSeesTheWallTurned) {
  AsBuiltSettings as_built = exact();
  as_built.mounting.angle_deg = 45.0;
  Carrier carrier(as_built);
  const Pose3 T_body_lidar = carrier.robot().actual().T_body("lidar");
  ASSERT_GT(std::abs(to_yaw(T_body_lidar.rotation)), 10.0 * kDegree);
  const auto scan = carrier.last<LaserScan>();
  int num_seen = 0;
  for (std::size_t beam = 0; beam < scan.ranges_m.size(); ++beam) {
    const double angle = angle_of(scan, beam);
    const Eigen::Vector3d direction = T_body_lidar.rotation * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0);
    if (direction.x() < 0.3) continue;
    EXPECT_NEAR(scan.ranges_m[beam], (kWall_m - 0.2) / direction.x(), 1e-4) << to_deg(angle);
    ++num_seen;
  }
  EXPECT_GT(num_seen, 200);
}

TEST(AsBuiltWiring, ALidarThatIsMountedOffItsPlaceIsNearerToTheWallOrFarther) {
  AsBuiltSettings as_built = exact();
  as_built.mounting.position_m = 0.1;
  Carrier carrier(as_built);
  const double x_m = carrier.robot().actual().T_body("lidar").position.x();
  ASSERT_GT(std::abs(x_m - 0.2), 0.01);
  EXPECT_NEAR(carrier.last<LaserScan>().ranges_m[360], kWall_m - x_m, 1e-4);
}

TEST(AsBuiltWiring, TheRangeOffsetOfALidarIsInEachOfItsRanges) {
  AsBuiltSettings as_built = exact();
  as_built.lidar.range_offset_m = LidarTolerances{}.range_offset_m;
  Carrier carrier(as_built);
  const double offset_m = carrier.robot().lidar("lidar").range_offset_m;
  ASSERT_GT(std::abs(offset_m), 0.001);
  const auto scan = carrier.last<LaserScan>();
  for (std::size_t beam = 300; beam <= 420; ++beam) {
    EXPECT_NEAR(scan.ranges_m[beam], (kWall_m - 0.2) / std::cos(angle_of(scan, beam)) + offset_m, 1e-4) << beam;
  }
}

/// The camera publishes intrinsics that are not those of its image, and 1 / depth with a constant error.
TEST(AsBuiltWiring, IntrinsicsAndInverseDepthOfADepthCameraDeviateOnAFlatWall) {
  AsBuiltSettings as_built = exact();
  as_built.depth_camera = DepthCameraTolerances{};
  as_built.depth_camera.inverse_depth_per_m = 0.03;
  Carrier carrier(as_built);
  const DepthCameraErrors errors = carrier.robot().depth_camera();
  ASSERT_GT(std::abs(errors.focal_scale - 1.0), 1e-4);
  ASSERT_GT(std::abs(errors.cx_px), 0.01);
  ASSERT_GT(std::abs(errors.cy_px), 0.01);
  ASSERT_NE(errors.cx_px, errors.cy_px);
  ASSERT_GT(std::abs(errors.inverse_depth_per_m), 0.002);
  const PinholeLens lens = make_lens(without_noise().depth_camera);
  const auto image = carrier.last<DepthImage>();
  EXPECT_NEAR(image.fx_px, lens.focal_px * errors.focal_scale, 1e-12);
  EXPECT_EQ(image.fx_px, image.fy_px);
  EXPECT_NEAR(image.cx_px, lens.cx_px() + errors.cx_px, 1e-12);
  EXPECT_NEAR(image.cy_px, lens.cy_px() + errors.cy_px, 1e-12);
  const double depth_m = 1.0 / (1.0 / 2.0 + errors.inverse_depth_per_m);
  for (const std::uint16_t depth_mm : image.depth_mm) ASSERT_NEAR(depth_mm, 1000.0 * depth_m, 0.51);
}

/// The number of missed edges is binomial; four standard deviations on either side.
TEST(AsBuiltWiring, HallEdgesAreMissedWithTheDrawnProbabilityOfTheDefaultAndOfALargerTolerance) {
  for (const auto& [tolerance, num_edges] :
       {std::pair(TrackTolerances{}.missed_edge_probability, 8'000'000), std::pair(0.2, 20'000)}) {
    AsBuiltSettings as_built = exact();
    as_built.tracks.missed_edge_probability = tolerance;
    Carrier carrier(as_built);
    const double probability = carrier.robot().tracks().missed_edge_probability;
    ASSERT_GT(probability, 0.3 * tolerance);
    ASSERT_LE(probability, tolerance);
    carrier.turn_sprockets_to((num_edges + 0.5) / without_noise().hall.ticks_per_rad());
    const auto ticks = carrier.last<TrackTicks>();
    const double expected = probability * num_edges, bound = 4.0 * std::sqrt(expected * (1.0 - probability));
    ASSERT_LT(bound, expected) << "no missed edge would pass";
    EXPECT_NEAR(static_cast<double>(num_edges - ticks.left), expected, bound) << tolerance;
    EXPECT_NEAR(static_cast<double>(num_edges - ticks.right), expected, bound) << tolerance;
    EXPECT_NE(ticks.left, ticks.right);
  }
}

const std::string kSurroundings = box("6 0 1", "0.5 8 2", R"( rgba="0.2 0.2 0.2 1" )") + box("0 -4 1", "8 0.5 2") +
                                  box("-5 0 1", "0.5 8 2") +
                                  R"(<site name="uwb_anchor_1" pos="3 2 2"/><site name="uwb_anchor_2" pos="-3 2 2"/>)";

/// Simulator of a robot between walls with all of its sensors.
class Room {
 public:
  Room(const std::string& urdf, const AsBuiltSettings& as_built)
      : file_("world.xml", make_flat_world(kSurroundings)), simulator_(make(urdf, as_built)) {}

  const mjModel& physics() const { return simulator_.physics(); }

  /// Returns all messages of a drive of 0.3 s, encoded, followed by the joint positions at its end.
  std::string drive() {
    std::string log;
    simulator_.set_command({.stamp = {}, .vx_mps = 0.5, .vy_mps = 0.0, .yaw_rate_radps = 0.3});
    while (simulator_.now() < from_seconds(0.3)) {
      simulator_.step();
      if (simulator_.now() == from_seconds(0.02)) simulator_.command(ScanCommand{simulator_.now()});
      for (const SensorMessage& message : simulator_.take_messages()) {
        log += std::visit([](const auto& content) { return io::encode(content); }, message);
      }
    }
    for (const double position : simulator_.state().qpos) log.append(reinterpret_cast<const char*>(&position), 8);
    return log;
  }

 private:
  Simulator make(const std::string& urdf, const AsBuiltSettings& as_built) const {
    SimulatorSettings settings;
    settings.world_xml = file_.path();
    settings.robot_urdf = urdf;
    settings.as_built = as_built;
    settings.sensors.tdlas.enabled = settings.sensors.gnss.enabled = false;
    settings.sensors.lidar.beams = 90;
    settings.sensors.lidar.rate_hz = 20.0;
    settings.sensors.lidar.range_quantization_m = 0.0;
    settings.sensors.imu.gyro_resolution_radps = settings.sensors.imu.accel_resolution_mps2 = 0.0;
    const RobotDescription robot = io::load_robot_description(urdf);
    settings.sensors.uwb.enabled = is_fitted<UwbRange>(robot) && robot.T_body_sensor.contains("uwb");
    settings.sensors.depth_camera.enabled = robot.T_body_sensor.contains("depth_camera");
    settings.sensors.scanner.enabled = robot.T_body_sensor.contains("scanner");
    settings.sensors.scanner.step_deg = 10.0;
    settings.sensors.scanner.duration_s = 0.1;
    settings.sensors.scanner.latency_s = 0.0;
    return Simulator(settings, robot, 1, test::make_wall_imager);
  }

  test::TemporaryFile file_;
  Simulator simulator_;
};

Pose3 site_pose(const mjModel& model, const char* name) {
  const int site = mj_name2id(&model, mjOBJ_SITE, name);
  const mjtNum* const q = model.site_quat + 4 * site;
  return {Eigen::Vector3d(model.site_pos + 3 * site), Eigen::Quaterniond(q[0], q[1], q[2], q[3])};
}

TEST(AsBuiltWiring, TheSiteOfTheImuMovesByItsMountingError) {
  for (const std::string& urdf : {kTrackedUrdf, kRobotUrdf}) {
    AsBuiltSettings as_built = exact();
    as_built.mounting = {.position_m = 0.02, .angle_deg = 5.0};
    const AsBuiltRobot robot(as_built, io::load_robot_description(urdf), 1);
    const Pose3 expected = robot.nominal().T_body("imu").inverse() * robot.actual().T_body("imu");
    ASSERT_GT(expected.position.norm(), 0.003);
    ASSERT_GT(expected.rotation.angularDistance(Eigen::Quaterniond::Identity()), 1.0 * kDegree);
    const Pose3 moved =
        site_pose(Room(urdf, exact()).physics(), "imu").inverse() * site_pose(Room(urdf, as_built).physics(), "imu");
    EXPECT_NEAR((moved.position - expected.position).norm(), 0.0, 1e-12) << urdf;
    EXPECT_NEAR(moved.rotation.angularDistance(expected.rotation), 0.0, 1e-7) << urdf;
  }
}

/// Returns the friction of all geoms of a robot whose names contain `part`.
std::vector<double> friction_of(const mjModel& physics, const std::string& part) {
  std::vector<double> friction;
  for (int geom = 0; geom < physics.ngeom; ++geom) {
    const char* name = mj_id2name(&physics, mjOBJ_GEOM, geom);
    if (name != nullptr && std::string(name).find(part) != std::string::npos)
      friction.push_back(physics.geom_friction[3 * geom]);
  }
  return friction;
}

/// Expects `count` geoms whose friction is `factor` times the nominal one.
void expect_friction(const std::string& urdf, const AsBuiltSettings& as_built, const std::string& part, double factor,
                     std::size_t count) {
  ASSERT_GT(std::abs(factor - 1.0), 0.01);
  const std::vector<double> nominal = friction_of(Room(urdf, exact()).physics(), part),
                            actual = friction_of(Room(urdf, as_built).physics(), part);
  ASSERT_EQ(nominal.size(), count);
  ASSERT_EQ(actual.size(), count);
  for (std::size_t geom = 0; geom < count; ++geom) EXPECT_NEAR(actual[geom] / nominal[geom], factor, 1e-12) << geom;
}

TEST(AsBuiltWiring, FeetAndWheelsHaveTheDrawnFriction) {
  AsBuiltSettings as_built = exact();
  as_built.legs.friction_scale = LegTolerances{}.friction_scale;
  as_built.tracks.friction_scale = TrackTolerances{}.friction_scale;
  const auto robot = [&](const std::string& urdf) {
    return AsBuiltRobot(as_built, io::load_robot_description(urdf), 1);
  };
  expect_friction(kRobotUrdf, as_built, "_foot", robot(kRobotUrdf).foot_friction_scale(), 4);
  expect_friction(kTrackedUrdf, as_built, "_wheel_", robot(kTrackedUrdf).tracks().friction_scale, 14);
}

/// The wheels of the two rows in the physics model, at its reference configuration, are the gauge of the URDF and the
/// drawn error apart; the robot's x axis stays midway.
TEST(AsBuiltWiring, TheRowsOfWheelsAreTheDrawnGaugeApart) {
  AsBuiltSettings as_built = exact();
  as_built.tracks.gauge_m = TrackTolerances{}.gauge_m;
  const AsBuiltRobot robot(as_built, io::load_robot_description(kTrackedUrdf), 1);
  const double error_m = robot.tracks().gauge_error_m;
  ASSERT_GT(std::abs(error_m), 0.0002);
  ASSERT_LE(std::abs(error_m), 0.002);
  const auto logged = robot.truth({}).values;
  EXPECT_EQ(std::count(logged.begin(), logged.end(), std::pair<std::string, double>("tracks.gauge_error_m", error_m)),
            1);
  const Room room(kTrackedUrdf, as_built);
  const mjModel& model = room.physics();
  const DataPtr data = make_data(model);
  mj_kinematics(&model, data.get());
  const auto y_m = [&](const std::string& side, int wheel) {
    const int geom = mj_name2id(&model, mjOBJ_GEOM, fmt::format("{}_wheel_{}", side, wheel).c_str());
    EXPECT_GE(geom, 0) << side << wheel;
    return data->geom_xpos[3 * std::max(geom, 0) + 1];
  };
  for (int wheel = 0; wheel < 7; ++wheel) {
    EXPECT_NEAR(y_m("left", wheel) - y_m("right", wheel), 0.55 + error_m, 1e-9) << wheel;
    EXPECT_NEAR(y_m("left", wheel) + y_m("right", wheel), 0.0, 1e-9) << wheel;
  }
}

/// The wheels of the two sides are the gauge of the URDF and the drawn error apart, with the drawn radius and friction.
TEST(AsBuiltWiring, WheelsHaveTheDrawnGaugeRadiusAndFriction) {
  AsBuiltSettings as_built = exact();
  as_built.wheels = WheelTolerances{};
  const AsBuiltRobot robot(as_built, io::load_robot_description(kWheeledUrdf), 1);
  const WheelErrors errors = robot.wheels();
  ASSERT_GT(std::abs(errors.gauge_error_m), 0.0002);
  const Room nominal(kWheeledUrdf, exact()), actual(kWheeledUrdf, as_built);
  const DataPtr data = make_data(actual.physics());
  mj_kinematics(&actual.physics(), data.get());
  for (std::size_t wheel = 0; wheel < 4; ++wheel) {
    const WheelGeometry& geometry = robot.nominal().wheels[wheel];
    const int geom = mj_name2id(&actual.physics(), mjOBJ_GEOM, geometry.link.c_str());
    ASSERT_GE(geom, 0);
    EXPECT_NEAR(actual.physics().geom_size[3 * geom] / nominal.physics().geom_size[3 * geom],
                errors.radius_scale[wheel], 1e-12);
    EXPECT_NEAR(std::abs(data->geom_xpos[3 * geom + 1]), 0.5 * (0.5708 + errors.gauge_error_m), 1e-9);
  }
  expect_friction(kWheeledUrdf, as_built, "_wheel", errors.friction_scale, 4);
}

/// Completeness: a number of section `as_built` that reaches no sensor and no physics fails here. Each of them has a
/// tenth of its largest value; then one of them at a time has its lowest.
TEST(AsBuiltWiring, RemovingAnyErrorChangesMessagesOrMotion) {
  AsBuiltSettings all = exact();
  std::vector<std::string> names;
  for_each_tolerance(all, [&](const std::string& name, double& value, const Limits& limits) {
    if (is_tolerance(name)) value = 0.1 * limits.max;
    names.push_back(name);
  });
  all.mounting = MountingTolerances{};   // the lidar stays outside of its post
  all.clock.transport_jitter_s = 0.003;  // messages arrive within the drive
  ASSERT_GT(names.size(), 40U);
  const std::string tracked = Room(kTrackedUrdf, all).drive(), legged = Room(kRobotUrdf, all).drive(),
                    wheeled = Room(kWheeledUrdf, all).drive();
  EXPECT_TRUE(Room(kTrackedUrdf, all).drive() == tracked) << "a run is repeatable";
  for (const std::string& name : names) {
    const bool is_of_legs = name.starts_with("legs.") || name.starts_with("joint_encoders.");
    const bool is_of_wheels = name.starts_with("wheels.");
    const std::string& urdf = is_of_legs ? kRobotUrdf : is_of_wheels ? kWheeledUrdf : kTrackedUrdf;
    const std::string& with_all = is_of_legs ? legged : is_of_wheels ? wheeled : tracked;
    EXPECT_TRUE(Room(urdf, without(all, name)).drive() != with_all) << name << " changes nothing";
  }
}

}  // namespace
}  // namespace patrol::sim::as_built_wiring_test
