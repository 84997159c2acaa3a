#include "localize/legged_odometry.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "tests/support/walking_robot.h"

namespace patrol::localize::legged_odometry_test {
namespace {

using test::make_quadruped;
using test::stand_then_walk;
using test::WalkingRobot;
using test::WalkingRobotSettings;

/// Messages that are delivered at a time.
struct Channels {
  bool imu = true, joints = true, contacts = true;
};
using Outage = std::function<Channels(double time_s)>;

void run(WalkingRobot& robot, LeggedOdometry& odometry, double until_s, const Outage& outage = nullptr) {
  while (to_seconds(robot.now()) < until_s) {
    robot.step();
    const Channels on = outage ? outage(to_seconds(robot.now())) : Channels{};
    if (on.joints) odometry.add(robot.joints());
    if (on.contacts) odometry.add(robot.contacts());
    if (on.imu) odometry.add(robot.imu());
  }
}

double yaw_error(const LeggedOdometry& odometry, const WalkingRobot& robot) {
  return wrap_angle(to_yaw(odometry.estimate()->T_odom_body.rotation) - to_yaw(robot.T_world_body().rotation));
}

double tilt_error(const LeggedOdometry& odometry, const WalkingRobot& robot) {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d up_estimated = odometry.estimate()->T_odom_body.rotation.conjugate() * up;
  const Eigen::Vector3d up_true = robot.T_world_body().rotation.conjugate() * up;
  return std::acos(std::min(1.0, up_estimated.dot(up_true)));
}

Eigen::Vector2d position_error(const LeggedOdometry& odometry, const WalkingRobot& robot) {
  return (odometry.estimate()->T_odom_body.position - robot.T_world_body().position).head<2>();
}

TEST(LeggedOdometry, HasNoEstimateBeforeImuAndLegReadings) {
  WalkingRobot robot(make_quadruped(), stand_then_walk(10.0, {}), {}, 1);
  LeggedOdometry odometry(make_quadruped(), {});
  EXPECT_FALSE(odometry.estimate());
  EXPECT_FALSE(odometry.T_odom_body_at(Time{0}));
  robot.step();
  odometry.add(robot.imu());
  EXPECT_FALSE(odometry.estimate()) << "the legs have not been heard";
}

TEST(LeggedOdometry, DoesNotTakeItsTiltFromARobotInFreeFall) {
  LeggedOdometry odometry(make_quadruped(), {});
  odometry.add(
      Imu{.stamp = Time{0}, .angular_velocity_radps = {0, 0, 0}, .linear_acceleration_mps2 = {0.05, 0.03, 0.08}});
  EXPECT_FALSE(odometry.filter());
  odometry.add(
      Imu{.stamp = from_seconds(0.004), .angular_velocity_radps = {0, 0, 0}, .linear_acceleration_mps2 = {0, 0, 9.81}});
  ASSERT_TRUE(odometry.filter());
  EXPECT_LT(std::acos(odometry.filter()->up_in_body().z()), 0.1 * kDegree);
}

TEST(LeggedOdometry, WithoutNoiseWalkOfTwentyMetersIsExactToOnePerMille) {
  WalkingRobot robot(make_quadruped(), stand_then_walk(1.0, {.vx_mps = 0.8}), WalkingRobotSettings::without_noise(), 1);
  LeggedOdometry odometry(make_quadruped(), {});
  run(robot, odometry, 26.5);
  EXPECT_NEAR(robot.way_m(), 20.0, 0.01);
  EXPECT_LT(position_error(odometry, robot).norm(), 0.02);
  EXPECT_LT(std::abs(yaw_error(odometry, robot)), 1e-3);
}

TEST(LeggedOdometry, IgnoringThatFeetRollWouldLoseFourPercent) {
  RobotDescription points = make_quadruped();
  for (LegGeometry& leg : points.legs) leg.foot_radius_m = 0.0;
  WalkingRobot robot(make_quadruped(), stand_then_walk(1.0, {.vx_mps = 0.8}), WalkingRobotSettings::without_noise(), 1);
  LeggedOdometry odometry(points, {});
  run(robot, odometry, 11.5);
  const double share = odometry.estimate()->T_odom_body.position.x() / robot.T_world_body().position.x();
  EXPECT_LT(share, 0.97);
  EXPECT_GT(share, 0.90);
}

TEST(LeggedOdometry, NoisyMinuteOfWalkingErrsLessThanOnePercentAndHalfADegree) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    WalkingRobot robot(make_quadruped(), stand_then_walk(4.0, {.vx_mps = 0.8}), {}, seed);
    LeggedOdometry odometry(make_quadruped(), {});
    run(robot, odometry, 65.0);
    EXPECT_LT(std::abs(position_error(odometry, robot).x()), 0.01 * robot.way_m());
    EXPECT_LT(std::abs(yaw_error(odometry, robot)), 0.5 * kDegree);
    EXPECT_LT(tilt_error(odometry, robot), 0.3 * kDegree);
  }
}

TEST(LeggedOdometry, CurvedWalkEndsWhereItShould) {
  WalkingRobot robot(make_quadruped(), stand_then_walk(4.0, {.vx_mps = 0.6, .vy_mps = 0.1, .yaw_rate_radps = 0.5}), {},
                     4);
  LeggedOdometry odometry(make_quadruped(), {});
  run(robot, odometry, 40.0);
  EXPECT_LT(position_error(odometry, robot).norm(), 0.01 * robot.way_m());
  // Odom does not jump back for the bias of the first second (0.002 rad/s, two standard deviations), learnt only at its
  // end; the rest is half a per mille of the 18 rad turned.
  EXPECT_LT(std::abs(yaw_error(odometry, robot)), 2.0 * 0.002 * 1.0 + 0.0005 * 18.0);
}

TEST(LeggedOdometry, FourSecondsAtRestEstimateTheGyroBias) {
  const WalkingRobotSettings settings;
  WalkingRobot robot(make_quadruped(), stand_then_walk(10.0, {}), settings, 5);
  LeggedOdometry odometry(make_quadruped(), {});
  run(robot, odometry, 4.2);
  const InertialFilter& filter = *odometry.filter();
  // Four windows of white noise over 0.8 s each: 2e-4 / sqrt(3.2) = 1.1e-4 rad/s, and the feet's own 1e-4
  // / 2.
  EXPECT_LT((filter.gyro_bias_radps() - settings.gyro_bias_radps).cwiseAbs().maxCoeff(), 4.0 * 1.5e-4);
  EXPECT_LT(odometry.health().gyro_z_bias_std_radps, 3e-4);
}

TEST(LeggedOdometry, OneSlippingFootOfTwoIsOutvoted) {
  WalkingRobotSettings settings;
  settings.slip = [](int leg, double time_s) {
    return leg == 0 && time_s > 5.0 ? Eigen::Vector3d(0.0, 0.5, 0.0) : Eigen::Vector3d(0.0, 0.0, 0.0);
  };
  WalkingRobot robot(make_quadruped(), stand_then_walk(2.0, {.vx_mps = 0.6}), settings, 6);
  LeggedOdometry odometry(make_quadruped(), {});
  run(robot, odometry, 10.0);
  // Half of the time two feet of which one slips: a plain mean would drift 0.5 / 2 * 0.6 * 5 s = 0.75 m
  // sideways.
  EXPECT_LT(std::abs(position_error(odometry, robot).y()), 0.1);
  EXPECT_GT(odometry.health().num_slips, 100U);
}

TEST(LeggedOdometry, HalfASecondWithoutImuIsSurvivedAndReported) {
  WalkingRobot robot(make_quadruped(), stand_then_walk(3.0, {.vx_mps = 0.8, .yaw_rate_radps = 0.3}), {}, 7);
  LeggedOdometry odometry(make_quadruped(), {});
  run(robot, odometry, 8.0);
  const double var_before = odometry.estimate()->planar_covariance(2, 2);
  run(robot, odometry, 8.5, [](double) { return Channels{.imu = false}; });
  EXPECT_TRUE(odometry.health().imu_timed_out);
  EXPECT_GT(odometry.estimate()->planar_covariance(2, 2), 2.0 * var_before);
  EXPECT_LT(to_seconds(robot.now() - odometry.estimate()->stamp), 0.11);
  run(robot, odometry, 12.0);
  EXPECT_FALSE(odometry.health().imu_timed_out);
  EXPECT_LT(position_error(odometry, robot).norm(), 0.15);
  EXPECT_LT(std::abs(yaw_error(odometry, robot)), 2.0 * kDegree);
}

TEST(LeggedOdometry, TenSecondsWithoutJointReadingsDoNotDiverge) {
  WalkingRobot robot(make_quadruped(), stand_then_walk(3.0, {.vx_mps = 0.5}), {}, 8);
  LeggedOdometry odometry(make_quadruped(), {});
  run(robot, odometry, 8.0);
  run(robot, odometry, 18.0, [](double) { return Channels{.joints = false}; });
  EXPECT_TRUE(odometry.health().legs_timed_out);
  EXPECT_LT(position_error(odometry, robot).norm(), 6.0);
  EXPECT_GT(std::sqrt(odometry.estimate()->planar_covariance(0, 0)), 0.2);
}

TEST(LeggedOdometry, WithoutFootSensorsTheLowestFeetAreInStance) {
  WalkingRobot robot(make_quadruped(), stand_then_walk(3.0, {.vx_mps = 0.8}), {}, 9);
  LeggedOdometry odometry(make_quadruped(), {});
  run(robot, odometry, 5.0);
  run(robot, odometry, 15.0, [](double) { return Channels{.contacts = false}; });
  EXPECT_TRUE(odometry.health().contacts_timed_out);
  EXPECT_LT(position_error(odometry, robot).norm(), 0.03 * robot.way_m());
}

TEST(LeggedOdometry, MessagesThatAreWrongChangeNothing) {
  WalkingRobot robot(make_quadruped(), stand_then_walk(1.0, {.vx_mps = 0.5}), {}, 10);
  LeggedOdometry odometry(make_quadruped(), {}), untouched(make_quadruped(), {});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  while (to_seconds(robot.now()) < 3.0) {
    robot.step();
    for (LeggedOdometry* each : {&odometry, &untouched}) {
      each->add(robot.imu());
      each->add(robot.joints());
      each->add(robot.contacts());
    }
    Imu bad_imu = robot.imu();
    bad_imu.stamp += std::chrono::milliseconds(1);
    bad_imu.angular_velocity_radps.x() = nan;
    JointState bad_joints = robot.joints();
    bad_joints.position_rad[3] = nan;
    JointState short_joints = robot.joints();
    short_joints.velocity_radps.pop_back();
    FootContacts bad_contacts = robot.contacts();
    bad_contacts.stamp += std::chrono::milliseconds(1);
    bad_contacts.force_n[0] = nan;
    odometry.add(bad_imu);
    odometry.add(bad_joints);
    odometry.add(short_joints);
    odometry.add(bad_contacts);
    odometry.add(robot.imu());  // a second time
  }
  EXPECT_EQ(odometry.estimate()->T_odom_body.position, untouched.estimate()->T_odom_body.position);
  EXPECT_GT(odometry.health().num_rejected_messages, 2000U);
  EXPECT_EQ(untouched.health().num_rejected_messages, 0U);
}

TEST(LeggedOdometry, OrderOfArrivalWithinAnInstantDoesNotMatter) {
  WalkingRobot robot(make_quadruped(), stand_then_walk(1.0, {.vx_mps = 0.5}), {}, 11);
  LeggedOdometry imu_first(make_quadruped(), {}), imu_last(make_quadruped(), {});
  while (to_seconds(robot.now()) < 3.0) {
    robot.step();
    imu_first.add(robot.imu());
    imu_first.add(robot.contacts());
    imu_first.add(robot.joints());
    imu_last.add(robot.joints());
    imu_last.add(robot.contacts());
    imu_last.add(robot.imu());
  }
  EXPECT_EQ(imu_first.estimate()->T_odom_body.position, imu_last.estimate()->T_odom_body.position);
}

TEST(LeggedOdometry, JointsThirtyMillisecondsLateCostLittle) {
  WalkingRobot robot(make_quadruped(), stand_then_walk(3.0, {.vx_mps = 0.8, .yaw_rate_radps = 0.3}), {}, 12);
  LeggedOdometry odometry(make_quadruped(), {});
  std::vector<std::pair<JointState, FootContacts>> on_the_way;
  while (to_seconds(robot.now()) < 20.0) {
    robot.step();
    odometry.add(robot.imu());
    on_the_way.emplace_back(robot.joints(), robot.contacts());
    if (on_the_way.size() <= 8) continue;
    odometry.add(on_the_way.front().first);
    odometry.add(on_the_way.front().second);
    on_the_way.erase(on_the_way.begin());
  }
  EXPECT_LT(position_error(odometry, robot).norm(), 0.02 * robot.way_m());
}

TEST(LeggedOdometry, RemembersASecondOfPoses) {
  WalkingRobot robot(make_quadruped(), stand_then_walk(1.0, {.vx_mps = 0.8, .yaw_rate_radps = 0.5}), {}, 13);
  LeggedOdometry odometry(make_quadruped(), {});
  run(robot, odometry, 5.0);
  const Time then = robot.now();
  const Pose3 truth_then = robot.T_world_body();
  run(robot, odometry, 6.0);
  const std::optional<Pose3> remembered = odometry.T_odom_body_at(then);
  ASSERT_TRUE(remembered);
  EXPECT_LT((remembered->position - truth_then.position).head<2>().norm(), 0.05);
  EXPECT_FALSE(odometry.T_odom_body_at(Time{0}));
  EXPECT_TRUE(odometry.T_odom_body_at(robot.now() + std::chrono::milliseconds(50)));
  EXPECT_FALSE(odometry.T_odom_body_at(robot.now() + std::chrono::milliseconds(500)));
}

TEST(LeggedOdometry, HeightAboveGroundIsThatOfTheWalk) {
  WalkingRobotSettings settings;
  settings.height_m = 0.28;
  WalkingRobot robot(make_quadruped(), stand_then_walk(1.0, {.vx_mps = 0.5}), settings, 14);
  LeggedOdometry odometry(make_quadruped(), {});
  run(robot, odometry, 5.0);
  EXPECT_NEAR(odometry.height_above_ground_m(), 0.28, 0.005);
}

TEST(LeggedOdometry, TiltedImuMountIsUndone) {
  RobotDescription tilted = make_quadruped();
  tilted.T_body_sensor["imu"] = Pose3{{0.1, 0.02, 0.03}, quaternion_from_rpy(0.1, -0.2, 1.5)};
  WalkingRobot robot(make_quadruped(), stand_then_walk(1.0, {.vx_mps = 0.5, .yaw_rate_radps = 0.5}),
                     WalkingRobotSettings::without_noise(), 15);
  LeggedOdometry odometry(tilted, {});
  const Pose3& T_body_imu = tilted.T_body_sensor["imu"];
  Eigen::Vector3d last_rate = Eigen::Vector3d::Zero();
  while (to_seconds(robot.now()) < 8.0) {
    robot.step();
    Imu imu = robot.imu();
    const Eigen::Vector3d rate = imu.angular_velocity_radps, lever = T_body_imu.position;
    const Eigen::Vector3d at_mount =
        imu.linear_acceleration_mps2 + rate.cross(rate.cross(lever)) + ((rate - last_rate) / 0.004).cross(lever);
    last_rate = rate;
    imu.angular_velocity_radps = T_body_imu.rotation.conjugate() * rate;
    imu.linear_acceleration_mps2 = T_body_imu.rotation.conjugate() * at_mount;
    odometry.add(imu);
    odometry.add(robot.joints());
    odometry.add(robot.contacts());
  }
  EXPECT_LT(position_error(odometry, robot).norm(), 0.01);
  EXPECT_LT(tilt_error(odometry, robot), 0.1 * kDegree);
}

TEST(LeggedOdometry, ErrorsAreConsistentWithTheCovariance) {
  // NEES of x, y, yaw after half a minute over 12 walks: chi-square of 36 degrees of freedom, divided by 12.
  // 95 % band of the mean: 21.3 / 12 ... 54.4 / 12. The lower end is not asked for: `position_random_walk_m_per_sqrt_m`
  // stands for slip and terrain, which this robot does not have, so the filter is too modest here.
  double sum = 0.0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    WalkingRobot robot(make_quadruped(), stand_then_walk(2.0, {.vx_mps = 0.7, .yaw_rate_radps = 0.2}), {}, seed);
    LeggedOdometry odometry(make_quadruped(), {});
    run(robot, odometry, 30.0);
    const Eigen::Vector2d position = position_error(odometry, robot);
    const Eigen::Vector3d error(position.x(), position.y(), yaw_error(odometry, robot));
    sum += error.dot(odometry.estimate()->planar_covariance.inverse() * error);
  }
  RecordProperty("mean_nees", std::to_string(sum / 12.0));
  EXPECT_LT(sum / 12.0, 54.4 / 12.0);
  EXPECT_GT(sum / 12.0, 0.2);
}

TEST(LeggedOdometry, RobotWithoutLegsIsRefusedByName) {
  RobotDescription cart;
  cart.name = "cart";
  try {
    LeggedOdometry odometry(cart, {});
    FAIL() << "a robot without legs was accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "robot cart: 0 legs: legged odometry requires 4");
  }
}

TEST(LeggedOdometry, SettingOutOfRangeIsRefusedByName) {
  LeggedOdometrySettings settings;
  settings.buffer_s = 0.0;
  try {
    LeggedOdometry odometry(make_quadruped(), settings);
    FAIL() << "a history of 0 s was accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("odometry.legged.buffer_s"), std::string::npos);
  }
}

}  // namespace
}  // namespace patrol::localize::legged_odometry_test
