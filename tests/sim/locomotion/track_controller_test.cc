#include "sim/locomotion/track_controller.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "sim/sensors/hall_sensors.h"
#include "tests/support/simulated_tracked_robot.h"

namespace patrol::sim::track_controller_test {
namespace {

constexpr double kTick_s = 0.002;
const double kTicksPerRad = HallSettings{}.ticks_per_rad();
constexpr DriveSpeedGains kGains{.kp_nms = 8.0, .ki_nm = 40.0, .kd_nms2 = 0.02, .observer_bandwidth_radps = 100.0};
constexpr DriveMotor kMotor{.max_torque_nm = 45.0, .stall_torque_nm = 120.0, .no_load_radps = 18.7};

TEST(DriveMotor, DrivesWithNoMoreThanItsLineAndBrakesWithAllItsCurrent) {
  EXPECT_DOUBLE_EQ(kMotor.feasible_torque_nm(100.0, 0.0), 45.0);
  EXPECT_NEAR(kMotor.feasible_torque_nm(100.0, 0.75 * 18.7), 30.0, 1e-12);  // 120 * (1 - 0.75)
  EXPECT_DOUBLE_EQ(kMotor.feasible_torque_nm(100.0, 18.7), 0.0);
  EXPECT_DOUBLE_EQ(kMotor.feasible_torque_nm(-100.0, 18.7), -45.0);
  EXPECT_DOUBLE_EQ(kMotor.feasible_torque_nm(7.0, 3.0), 7.0);
}

/// A sprocket with nothing but its inertia and a load against it.
struct LoneSprocket {
  DriveSpeedController regulator{kGains, kMotor, kTicksPerRad, kTick_s};
  double inertia_kgm2 = 0.5;
  double angle_rad = 0.0, speed_radps = 0.0;

  double step(double requested_radps, double load_nm = 0.0) {
    const auto count = static_cast<std::int64_t>(std::floor(angle_rad * kTicksPerRad));
    const double torque = regulator.step(requested_radps, count);
    speed_radps += kTick_s * (torque - load_nm) / inertia_kgm2;
    angle_rad += kTick_s * speed_radps;
    return torque;
  }
  void run(double requested_radps, double duration_s, double load_nm = 0.0) {
    for (double t = 0.0; t < duration_s; t += kTick_s) step(requested_radps, load_nm);
  }
};

TEST(DriveSpeedController, UnderALoadOf15NmItTurnsAt7RadPerSecondToWithin1PercentByTheTicks) {
  LoneSprocket sprocket;
  sprocket.run(7.0, 2.0, 15.0);
  const double start = sprocket.angle_rad;
  sprocket.run(7.0, 2.0, 15.0);
  EXPECT_NEAR(sprocket.angle_rad - start, 14.0, 0.14);
  EXPECT_NEAR(sprocket.regulator.speed_radps(), 7.0, 0.5);
}

TEST(DriveSpeedController, IsStableWithTheInertiaOfABeltOnIceAndOfTheWholeRobot) {
  for (const double inertia : {0.16, 0.6}) {
    LoneSprocket sprocket{.inertia_kgm2 = inertia};
    sprocket.run(5.0, 2.0);
    double slowest = 1e9, fastest = 0.0;
    for (int i = 0; i < 500; ++i) {
      sprocket.step(5.0);
      slowest = std::min(slowest, sprocket.speed_radps);
      fastest = std::max(fastest, sprocket.speed_radps);
    }
    EXPECT_GT(slowest, 4.8) << inertia;
    EXPECT_LT(fastest, 5.2) << inertia;
  }
}

TEST(DriveSpeedController, AfterTenSecondsOfStallItOvershootsByLessThanAFifthOfARadian) {
  LoneSprocket sprocket;
  for (double t = 0.0; t < 10.0; t += kTick_s) EXPECT_LE(sprocket.regulator.step(5.0, 0), 45.0);
  sprocket.run(0.0, 1.0);
  // Anti-windup: at the limit of 45 N m the integral holds 45 N m / 40 N m/rad less the proportional part of 40 N m.
  EXPECT_LT(std::abs(sprocket.angle_rad), 0.2);
}

Imu level_imu(double yaw_rate_radps = 0.0) {
  return {
      .stamp = {}, .angular_velocity_radps = {0.0, 0.0, yaw_rate_radps}, .linear_acceleration_mps2 = {0.0, 0.0, 9.81}};
}

VelocityCommand command(double vx_mps, double yaw_rate_radps) {
  return {.stamp = {}, .vx_mps = vx_mps, .vy_mps = 0.0, .yaw_rate_radps = yaw_rate_radps};
}

/// The belts' speeds that the firmware asks for: sprockets without load follow it.
struct BenchRun {
  explicit BenchRun(const TrackDriveSettings& settings) : controller(tracked_description(), settings, kTicksPerRad) {}

  void run(const VelocityCommand& asked, double duration_s, double gyro_radps = 0.0) {
    for (double t = 0.0; t < duration_s; t += kTick_s) {
      const auto count = [](double rad) { return static_cast<std::int64_t>(std::floor(rad * kTicksPerRad)); };
      const TrackTicks ticks{.stamp = {}, .left = count(angle[0]), .right = count(angle[1])};
      drive_command = controller.step(level_imu(gyro_radps), ticks, asked);
      for (std::size_t side = 0; side < 2; ++side) {
        speed[side] += kTick_s * drive_command.torque_nm[side] / 0.3;
        angle[side] += kTick_s * speed[side];
      }
    }
  }
  double belt_mps(std::size_t side) const { return 0.070 * speed[side]; }

  TrackController controller;
  TrackDriveCommand drive_command;
  double angle[2] = {}, speed[2] = {};
};

TEST(TrackController, AHalfMetreASecondAndThreeTenthsOfARadianAreBeltsAt0_384And0_616) {
  TrackDriveSettings settings;
  settings.use_gyro = false;
  BenchRun bench(settings);
  bench.run(command(0.5, 0.3), 3.0);
  // 0.5 -+ 0.3 * 1.41 * 0.55 / 2
  EXPECT_NEAR(bench.belt_mps(0), 0.3837, 0.01);
  EXPECT_NEAR(bench.belt_mps(1), 0.6163, 0.01);
}

TEST(TrackController, TooFastACurveIsDrivenSlowerButNotWider) {
  TrackDriveSettings settings;
  settings.use_gyro = false;
  BenchRun bench(settings);
  bench.run(command(1.0, 0.8), 4.0);
  EXPECT_NEAR(bench.belt_mps(1), 1.0, 0.02);
  // (1 - 0.8 * 0.38775) / (1 + 0.8 * 0.38775)
  EXPECT_NEAR(bench.belt_mps(0) / bench.belt_mps(1), 0.5265, 0.01);
}

TEST(TrackController, ItTakesNoLessThanTheSecondAndAQuarterThatItsAccelerationAllows) {
  BenchRun bench({});
  bench.run(command(1.0, 0.0), 1.0);
  EXPECT_NEAR(bench.belt_mps(0), 0.8, 0.03);  // 1 s at 0.8 m/s2
}

TEST(TrackController, WhenTheGyroReadsTooLittleTheBeltsTurnFaster) {
  BenchRun with({}), without({});
  with.run(command(0.0, 0.4), 2.0, 0.3);
  without.run(command(0.0, 0.4), 2.0, 0.4);
  EXPECT_GT(with.belt_mps(1), 1.2 * without.belt_mps(1));
  EXPECT_NEAR(with.belt_mps(0), -with.belt_mps(1), 0.01);
}

TEST(TrackController, TheBrakeClosesAfterHalfASecondAtRestAndOpensOnCommand) {
  BenchRun bench({});
  bench.run(command(0.0, 0.0), 0.4);
  EXPECT_FALSE(bench.drive_command.is_brake_closed);
  bench.run(command(0.0, 0.0), 0.2);
  EXPECT_TRUE(bench.drive_command.is_brake_closed);
  EXPECT_EQ(bench.drive_command.torque_nm[0], 0.0);
  bench.run(command(0.3, 0.0), 0.05);
  EXPECT_FALSE(bench.drive_command.is_brake_closed);
}

TEST(TrackController, BeyondSixtyDegreesFor300MillisecondsIsAFall) {
  for (const double tilt_deg : {50.0, 70.0}) {
    TrackController controller(tracked_description(), {}, kTicksPerRad);
    Imu imu = level_imu();
    const double tilt = to_rad(tilt_deg);
    imu.linear_acceleration_mps2 = {0.0, 9.81 * std::sin(tilt), 9.81 * std::cos(tilt)};
    for (int tick = 0; tick < 100; ++tick) controller.step(imu, {}, {});
    EXPECT_FALSE(controller.has_fallen()) << "0.2 s";
    for (int tick = 0; tick < 400; ++tick) controller.step(imu, {}, {});
    EXPECT_EQ(controller.has_fallen(), tilt_deg > 60.0) << tilt_deg;
  }
}

}  // namespace
}  // namespace patrol::sim::track_controller_test
