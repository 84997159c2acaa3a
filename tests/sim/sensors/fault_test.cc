#include "sim/sensors/fault.h"

#include <cmath>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "io/urdf.h"
#include "sim/sensors/sensor_suite.h"
#include "tests/support/simulated_quadruped.h"

namespace patrol::sim::fault_test {
namespace {

/// A message and when it came out.
struct Arrival {
  Time at;
  SensorMessage message;
  Time stamp() const {
    return std::visit([](const auto& content) { return content.stamp; }, message);
  }
};

/// The sensors of a robot that stands still on the plane, in front of a wall; it is held there, no physics
/// runs.
class HeldRobot {
 public:
  HeldRobot() : robot_(make_flat_world(R"(<geom type="box" pos="5 0 1" size="0.5 5 2" rgba="1 1 1 1"/>)")) {}

  /// Everything that arrives within `seconds`, by the message's type.
  std::map<std::size_t, std::vector<Arrival>> run(const SensorSuiteSettings& settings,
                                                  const std::vector<FaultSettings>& faults, double seconds,
                                                  std::vector<FaultStatus>* reports = nullptr) {
    SensorSuite suite(settings, AsBuiltRobot(io::load_robot_description(kRobotUrdf)), robot_.model(), robot_.view(),
                      GasPlume(Eigen::Vector3d::Zero(), 0.0, {}), faults, 1);
    std::map<std::size_t, std::vector<Arrival>> arrivals;
    for (Time now{}; now <= from_seconds(seconds); now += std::chrono::milliseconds(2)) {
      suite.step(robot_.model(), robot_.data(), now);
      for (SensorMessage& message : suite.take_due(now)) arrivals[message.index()].push_back({now, std::move(message)});
    }
    if (reports != nullptr) *reports = suite.faults();
    return arrivals;
  }

  template <typename Message>
  std::vector<Arrival> run_for(const SensorSuiteSettings& settings, const std::vector<FaultSettings>& faults,
                               double seconds) {
    return run(settings, faults, seconds)[SensorMessage(Message{}).index()];
  }

 private:
  WalkingRobot robot_;
};

FaultSettings fault(std::string sensor, std::string kind, double start_s, double duration_s, double magnitude = 1.0) {
  return {.sensor = std::move(sensor),
          .kind = std::move(kind),
          .start_s = start_s,
          .duration_s = duration_s,
          .magnitude = magnitude};
}

TEST(SensorSuite, EverySensorSpeaksAtItsRate) {
  auto arrivals = HeldRobot().run({}, {}, 1.999);
  const auto count = [&](const SensorMessage& kind) { return arrivals[kind.index()].size(); };
  EXPECT_EQ(count(Imu{}), 500u);
  EXPECT_EQ(count(JointState{}), 500u);
  EXPECT_EQ(count(FootContacts{}), 500u);
  EXPECT_EQ(count(LaserScan{}), 19u);  // the first ends at 0.1 s; the twentieth is still on its way
  EXPECT_EQ(count(GasReading{}), 19u);
  EXPECT_EQ(count(GnssFix{}), 10u);
  EXPECT_EQ(count(PointCloud{}), 0u);  // switched off
}

TEST(SensorSuite, AMessageComesOutItsLatencyAfterTheInstantItIsTrueOf) {
  SensorSuiteSettings settings;
  settings.imu.latency_s = 0.006;
  settings.lidar.latency_s = 0.034;
  settings.tdlas.latency_s = 0.1;
  settings.gnss.latency_s = 0.25;
  auto arrivals = HeldRobot().run(settings, {}, 1.0);
  const auto expect_latency = [&](const SensorMessage& kind, double latency_s, double after_stamp_s) {
    ASSERT_FALSE(arrivals[kind.index()].empty());
    for (const Arrival& arrival : arrivals[kind.index()]) {
      EXPECT_NEAR(to_seconds(arrival.at - arrival.stamp()), latency_s + after_stamp_s,
                  0.0021);  // up to the next tick
    }
  };
  expect_latency(Imu{}, 0.006, 0.0);
  expect_latency(LaserScan{}, 0.034,
                 0.1 * 3199.0 / 3200.0);  // stamped with its first beam, ready with its last
  expect_latency(GasReading{}, 0.1, 0.0);
  expect_latency(GnssFix{}, 0.25, 0.0);
}

TEST(SensorSuite, LatencyAloneChangesNoReading) {
  SensorSuiteSettings late;
  late.imu.latency_s = 0.05;
  HeldRobot robot;
  const auto now = robot.run_for<Imu>({}, {}, 0.5), then = robot.run_for<Imu>(late, {}, 0.5);
  ASSERT_GT(then.size(), 100u);
  for (std::size_t i = 0; i < then.size(); ++i) {
    EXPECT_EQ(std::get<Imu>(now[i].message).angular_velocity_radps,
              std::get<Imu>(then[i].message).angular_velocity_radps);
  }
}

TEST(Fault, SilenceOfHalfASecondTakes125ImuMessagesAndNoOther) {
  HeldRobot robot;
  std::vector<FaultStatus> reports;
  auto arrivals = robot.run({}, {fault("imu", "dropout", 0.5, 0.5)}, 1.499, &reports);
  EXPECT_EQ(arrivals[SensorMessage(Imu{}).index()].size(), 375u - 125u);
  EXPECT_EQ(arrivals[SensorMessage(JointState{}).index()].size(), 375u);
  for (const Arrival& arrival : arrivals[SensorMessage(Imu{}).index()]) {
    EXPECT_FALSE(arrival.stamp() >= from_seconds(0.5) && arrival.stamp() < from_seconds(1.0));
  }
  ASSERT_EQ(reports.size(), 1u);
  EXPECT_TRUE(reports[0].was_triggered);
}

TEST(Fault, AFrozenImuRepeatsItsLastReadingUnderNewStamps) {
  const auto arrivals = HeldRobot().run_for<Imu>({}, {fault("imu", "freeze", 0.2, 0.2)}, 0.6);
  const Imu* last_good = nullptr;
  int frozen = 0;
  for (const Arrival& arrival : arrivals) {
    const Imu& imu = std::get<Imu>(arrival.message);
    if (arrival.stamp() < from_seconds(0.2)) last_good = &imu;
    if (arrival.stamp() < from_seconds(0.2) || arrival.stamp() >= from_seconds(0.4)) continue;
    EXPECT_EQ(imu.angular_velocity_radps, last_good->angular_velocity_radps);
    EXPECT_EQ(imu.linear_acceleration_mps2, last_good->linear_acceleration_mps2);
    ++frozen;
  }
  EXPECT_EQ(frozen, 50);
}

TEST(Fault, ADelayOf0_3SecondsHoldsMessagesBackAndKeepsTheirStamps) {
  const auto arrivals = HeldRobot().run_for<GasReading>({}, {fault("tdlas", "delay", 0.5, 0.5, 0.3)}, 2.0);
  for (const Arrival& arrival : arrivals) {
    const bool is_held = arrival.stamp() >= from_seconds(0.5) && arrival.stamp() < from_seconds(1.0);
    EXPECT_NEAR(to_seconds(arrival.at - arrival.stamp()), is_held ? 0.4 : 0.1, 0.0021);
  }
}

TEST(Fault, ADriftOf0_1RadiansPerSecondSquaredOnTheYawRateGrowsFromItsStartAndEndsWithIt) {
  HeldRobot robot;
  const auto good = robot.run_for<Imu>({}, {}, 1.5),
             bad = robot.run_for<Imu>({}, {fault("imu", "drift", 0.5, 0.5, 0.1)}, 1.5);
  ASSERT_EQ(good.size(), bad.size());
  for (std::size_t i = 0; i < good.size(); ++i) {
    const double now = to_seconds(good[i].stamp());
    const double expected = now >= 0.5 && now < 1.0 ? 0.1 * (now - 0.5) : 0.0;
    const Imu &a = std::get<Imu>(good[i].message), &b = std::get<Imu>(bad[i].message);
    EXPECT_NEAR(b.angular_velocity_radps.z() - a.angular_velocity_radps.z(), expected, 1e-9) << now;
    EXPECT_EQ(b.angular_velocity_radps.x(), a.angular_velocity_radps.x());
  }
}

TEST(Fault, SpikesOf100NewtonsTouchOneFootMessageInTen) {
  HeldRobot robot;
  const auto good = robot.run_for<FootContacts>({}, {}, 8.0);
  const auto bad = robot.run_for<FootContacts>({}, {fault("foot_contact", "outliers", 0.0, 10.0, 100.0)}, 8.0);
  int outliers = 0;
  for (std::size_t i = 0; i < good.size(); ++i) {
    const double difference =
        std::get<FootContacts>(bad[i].message).force_n[0] - std::get<FootContacts>(good[i].message).force_n[0];
    EXPECT_TRUE(difference == 0.0 || std::abs(difference - 100.0) < 1e-9);
    outliers += difference != 0.0;
  }
  EXPECT_NEAR(outliers, 200, 4.0 * std::sqrt(2000 * 0.1 * 0.9));
}

TEST(Fault, NoFaultChangesTheRandomDrawsOfAnotherOne) {
  const std::vector<FaultSettings> faults = {fault("foot_contact", "outliers", 0.0, 10.0, 100.0),
                                             fault("imu", "jitter", 0.0, 10.0, 0.01)};
  const std::vector<FaultSettings> others = {fault("imu", "outliers", 0.0, 10.0), fault("gnss", "jitter", 0.0, 10.0),
                                             fault("foot_contact", "dropout", 0.2, 0.1), faults[0], faults[1]};
  HeldRobot robot;
  auto alone = robot.run({}, faults, 1.0), together = robot.run({}, others, 1.0);
  const auto arrivals_after = [](const std::vector<Arrival>& arrivals) {
    std::map<Time, Time> after;  // the time of each arrival by its stamp
    for (const Arrival& arrival : arrivals) after[arrival.stamp()] = arrival.at;
    return after;
  };
  const std::size_t imu = SensorMessage(Imu{}).index(), feet = SensorMessage(FootContacts{}).index();
  EXPECT_EQ(arrivals_after(alone[imu]), arrivals_after(together[imu]));
  std::map<Time, double> forces_n;
  for (const Arrival& arrival : alone[feet])
    forces_n[arrival.stamp()] = std::get<FootContacts>(arrival.message).force_n[0];
  ASSERT_GT(together[feet].size(), 200u);
  for (const Arrival& arrival : together[feet])
    EXPECT_EQ(std::get<FootContacts>(arrival.message).force_n[0], forces_n.at(arrival.stamp()));
}

TEST(Fault, TwoFaultsOfOneKindAndSensorDrawIndependently) {
  HeldRobot robot;
  const auto one = fault("foot_contact", "outliers", 0.0, 10.0, 100.0);
  const auto good = robot.run_for<FootContacts>({}, {}, 4.0), bad = robot.run_for<FootContacts>({}, {one, one}, 4.0);
  int num_single = 0;
  for (std::size_t i = 0; i < good.size(); ++i) {
    const double difference =
        std::get<FootContacts>(bad[i].message).force_n[0] - std::get<FootContacts>(good[i].message).force_n[0];
    num_single += std::abs(difference - 100.0) < 1e-9;
  }
  EXPECT_NEAR(num_single, 180, 4.0 * std::sqrt(1000 * 0.18 * 0.82));
}

TEST(Fault, ALidarsDriftMovesItsRangesAndGnssLosesItsHeight) {
  HeldRobot robot;
  const auto good = robot.run_for<LaserScan>({}, {}, 0.75),
             bad = robot.run_for<LaserScan>({}, {fault("lidar", "drift", 0.3, 1.0, 1.0)}, 0.75);
  const LaserScan &a = std::get<LaserScan>(good.back().message), &b = std::get<LaserScan>(bad.back().message);
  const double ready = to_seconds(a.stamp) + 0.1 * 3199.0 / 3200.0;
  for (std::size_t beam = 0; beam < a.ranges_m.size(); ++beam) {
    if (!std::isfinite(a.ranges_m[beam])) continue;
    EXPECT_NEAR(b.ranges_m[beam] - a.ranges_m[beam], ready - 0.3, 0.0021);
  }
  const auto fixes = robot.run_for<GnssFix>({}, {}, 0.5),
             drifting = robot.run_for<GnssFix>({}, {fault("gnss", "drift", 0.0, 1.0, 10.0)}, 0.5);
  EXPECT_NEAR(std::get<GnssFix>(drifting[1].message).altitude_m - std::get<GnssFix>(fixes[1].message).altitude_m, 2.0,
              1e-9);
}

TEST(Fault, OneThatNeverComesIsReportedAsNotExecuted) {
  std::vector<FaultStatus> reports;
  HeldRobot().run({}, {fault("imu", "dropout", 100.0, 1.0), fault("lidar3d", "dropout", 0.0, 1.0)}, 0.5, &reports);
  ASSERT_EQ(reports.size(), 2u);
  EXPECT_FALSE(reports[0].was_triggered);
  EXPECT_FALSE(reports[1].was_triggered);  // that lidar is switched off
}

TEST(Fault, AFreezeBeforeTheFirstReadingHasNothingToRepeatAndIsNotExecuted) {
  SensorSuiteSettings settings;
  settings.gnss.rate_hz = 1.0;
  std::vector<FaultStatus> reports;
  HeldRobot().run(settings, {fault("gnss", "freeze", 0.0, 0.5)}, 0.6, &reports);
  EXPECT_FALSE(reports[0].was_triggered);
}

}  // namespace
}  // namespace patrol::sim::fault_test
