#include <cmath>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "io/urdf.h"
#include "localize/legged_odometry.h"
#include "sim/simulator/simulator.h"
#include "tests/support/temporary_file.h"

/// The stack's odometry against MuJoCo's truth on the real trot, with the sensors at their defaults.
namespace patrol::leg_odometry_on_mujoco_test {
namespace {

const std::string kRobotUrdf = PATROL_SOURCE_DIR "/models/quadruped/quadruped.urdf";

const char* const kFlatWorld = R"(<mujoco><option timestep="0.002" cone="elliptic" impratio="10"/>
  <default><geom contype="1" conaffinity="2"/></default>
  <worldbody><geom name="ground" type="plane" size="500 500 1"/></worldbody></mujoco>)";

/// A part of a walk.
struct Leg {
  double duration_s;
  VelocityCommand command;
};

Leg go(double duration_s, double vx_mps, double yaw_rate_radps = 0.0) {
  return {duration_s, {.stamp = {}, .vx_mps = vx_mps, .vy_mps = 0.0, .yaw_rate_radps = yaw_rate_radps}};
}

struct OdometryReport {
  double way_m = 0.0;  ///< true
  double scale = 0.0;  ///< estimated way over true way
  double end_error_m = 0.0;
  double max_yaw_error_rad = 0.0;
  double tilt_rms_rad = 0.0;
  double height_rms_m = 0.0;  ///< RMS error of the height above ground
  double velocity_rms_mps = 0.0;
};

OdometryReport walk(const std::vector<Leg>& legs, std::uint64_t seed,
                    const localize::LeggedOdometrySettings& settings = {}) {
  const test::TemporaryFile world("flat.xml", kFlatWorld);
  const RobotDescription robot = io::load_robot_description(kRobotUrdf);
  sim::SimulatorSettings simulator_settings;
  simulator_settings.world_xml = world.path();
  simulator_settings.robot_urdf = kRobotUrdf;
  simulator_settings.sensors.lidar.enabled = false;
  sim::Simulator simulator(simulator_settings, robot, seed);
  localize::LeggedOdometry odometry(robot, settings);

  OdometryReport report;
  const Pose3 start = to_pose3(to_pose2(simulator.truth().T_world_body), simulator.truth().T_world_body.position.z());
  Pose3 truth_before = start, estimate_before;
  double estimated_way = 0.0;
  int samples = 0;
  for (const Leg& leg : legs) {
    simulator.set_command(leg.command);
    const Time end = simulator.now() + from_seconds(leg.duration_s);
    while (simulator.now() < end) {
      simulator.step();
      for (const SensorMessage& message : simulator.take_messages()) {
        std::visit(
            [&](const auto& m) {
              if constexpr (requires { odometry.add(m); }) odometry.add(m);
            },
            message);
      }
      const auto estimate = odometry.estimate();
      if (!estimate || estimate->stamp != simulator.now()) continue;
      const GroundTruth truth = simulator.truth();
      const Pose3 T_odom_body = start.inverse() * truth.T_world_body;
      const double yaw_error = wrap_angle(to_yaw(estimate->T_odom_body.rotation) - to_yaw(T_odom_body.rotation));
      report.max_yaw_error_rad = std::max(report.max_yaw_error_rad, std::abs(yaw_error));
      const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
      const double cos_tilt =
          (T_odom_body.rotation.conjugate() * up).dot(estimate->T_odom_body.rotation.conjugate() * up);
      report.tilt_rms_rad += std::pow(std::acos(std::min(1.0, cos_tilt)), 2);
      report.height_rms_m += std::pow(odometry.height_above_ground_m() - truth.T_world_body.position.z(), 2);
      report.velocity_rms_mps += (estimate->twist.linear - truth.twist.linear).squaredNorm();
      ++samples;
      if (samples % 90 == 0) {  // a gait period
        report.way_m += (truth.T_world_body.position - truth_before.position).head<2>().norm();
        estimated_way += (estimate->T_odom_body.position - estimate_before.position).head<2>().norm();
        truth_before = truth.T_world_body;
        estimate_before = estimate->T_odom_body;
      }
      const Eigen::Vector3d error = estimate->T_odom_body.position - T_odom_body.position;
      report.end_error_m = error.head<2>().norm();
    }
  }
  EXPECT_FALSE(simulator.has_fallen());
  report.scale = report.way_m > 0.0 ? estimated_way / report.way_m : 1.0;
  report.tilt_rms_rad = std::sqrt(report.tilt_rms_rad / samples);
  report.height_rms_m = std::sqrt(report.height_rms_m / samples);
  report.velocity_rms_mps = std::sqrt(report.velocity_rms_mps / samples);
  return report;
}

class LegOdometryOnMujoco : public testing::TestWithParam<std::uint64_t> {};

TEST_P(LegOdometryOnMujoco, FiftyMetresAheadErrLessThanOnePercentAndOneDegree) {
  const OdometryReport report = walk({go(3.0, 0.0), go(60.0, 0.8)}, GetParam());
  EXPECT_GT(report.way_m, 45.0);
  EXPECT_NEAR(report.scale, 1.0, 0.01);
  EXPECT_LT(report.end_error_m, 0.01 * report.way_m);
  EXPECT_LT(report.max_yaw_error_rad, 1.0 * kDegree);
  EXPECT_LT(report.tilt_rms_rad, 1.0 * kDegree);
  EXPECT_LT(report.height_rms_m, 0.003);
  EXPECT_LT(report.velocity_rms_mps, 0.06);
}

TEST_P(LegOdometryOnMujoco, BackwardsTheScaleHoldsToOnePercent) {
  const OdometryReport report = walk({go(3.0, 0.0), go(30.0, -0.3)}, GetParam());
  EXPECT_NEAR(report.scale, 1.0, 0.01);
  EXPECT_LT(report.end_error_m, 0.01 * report.way_m);
}

TEST_P(LegOdometryOnMujoco, ToldToWalkAtOnceItStandsHalfASecondAndTheScaleHolds) {
  const OdometryReport report = walk({go(20.0, 0.8)}, GetParam());
  EXPECT_NEAR(report.scale, 1.0, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Seeds, LegOdometryOnMujoco, testing::Values(1U, 2U));

}  // namespace
}  // namespace patrol::leg_odometry_on_mujoco_test
