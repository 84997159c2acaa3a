#include "sim/sensors/sensor_suite.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/sim/small_world.h"
#include "tests/support/wall_imager.h"

namespace patrol::sim::sensor_suite_test {
namespace {

/// A box on wheels that nobody sees: what carries the sensors of a tracked robot. It stands at the origin, 1 m up.
const std::string kWorld = R"(<site name="uwb_anchor_1" pos="8 0 1"/><site name="uwb_anchor_2" pos="0 8 1"/>
    <geom type="box" pos="3 0 1" size="0.5 3 3" rgba="1 1 1 1"/>
    <body name="base_link" pos="0 0 1"><freejoint/><inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/><site name="imu"/></body>)";

RobotDescription make_robot() {
  RobotDescription robot;
  robot.name = "carrier";
  for (const char* frame : {"lidar", "imu", "uwb", "ultrasonic_0", "ultrasonic_1", "depth_camera", "scanner"})
    robot.T_body_sensor[frame] = {};
  return robot;
}

/// Only the sensors under test.
SensorSuiteSettings quiet() {
  SensorSuiteSettings settings;
  settings.lidar.enabled = settings.imu.enabled = settings.joint_encoders.enabled = false;
  settings.foot_contact.enabled = settings.tdlas.enabled = settings.gnss.enabled = false;
  return settings;
}

struct Arrival {
  Time at;
  SensorMessage message;
  Time stamp() const {
    return std::visit([](const auto& content) { return content.stamp; }, message);
  }
};

struct Ride {
  std::vector<Arrival> arrivals;
  std::vector<FaultStatus> faults;
  int busy_ticks = 0;

  template <typename Message>
  std::vector<Arrival> of() const {
    std::vector<Arrival> chosen;
    for (const Arrival& arrival : arrivals) {
      if (std::holds_alternative<Message>(arrival.message)) chosen.push_back(arrival);
    }
    return chosen;
  }
};

Ride stand(const SensorSuiteSettings& settings, double seconds, const std::vector<FaultSettings>& faults = {},
           const RobotDescription& robot = make_robot(), const DepthImagerFactory& make_imager = test::make_wall_imager,
           const std::vector<Time>& scans_asked = {}, const AsBuiltSettings& as_built = {}, bool has_thread = false) {
  SmallWorld world(kWorld);
  SensorSuite suite(settings, AsBuiltRobot(as_built, robot, 1), *world.model, *world.model,
                    GasPlume(Eigen::Vector3d::Zero(), 0.0, {}), faults, 1, make_imager, {}, has_thread);
  Ride ride;
  for (Time now{}; now <= from_seconds(seconds); now += std::chrono::milliseconds(2)) {
    suite.step(*world.model, *world.data, now);
    for (SensorMessage& message : suite.take_due(now)) ride.arrivals.push_back({now, std::move(message)});
    if (std::find(scans_asked.begin(), scans_asked.end(), now) != scans_asked.end()) suite.command(ScanCommand{now});
    ride.busy_ticks += suite.is_busy();
  }
  ride.faults = suite.faults();
  return ride;
}

FaultSettings fault(std::string sensor, std::string kind, double start_s, double duration_s, double magnitude = 1.0) {
  return {.sensor = std::move(sensor),
          .kind = std::move(kind),
          .start_s = start_s,
          .duration_s = duration_s,
          .magnitude = magnitude};
}

SensorSuiteSettings with_uwb() {
  SensorSuiteSettings settings = quiet();
  settings.uwb.enabled = true;
  settings.uwb.rate_hz = 25.0;
  settings.uwb.loss_probability = 0.0;
  settings.uwb.range_max_m = 100.0;
  settings.uwb.nlos_loss_probability = 0.0;
  return settings;
}

SensorSuiteSettings with_ultrasonic() {
  SensorSuiteSettings settings = quiet();
  settings.ultrasonic.enabled = true;
  settings.ultrasonic.dropout_probability = 0.0;
  return settings;
}

SensorSuiteSettings with_depth_camera() {
  SensorSuiteSettings settings = quiet();
  settings.depth_camera.enabled = true;
  settings.depth_camera.dropout_probability = 0.0;
  return settings;
}

SensorSuiteSettings with_scanner() {
  SensorSuiteSettings settings = quiet();
  settings.scanner.enabled = true;
  settings.scanner.step_deg = 5.0;
  settings.scanner.duration_s = 2.0;
  settings.scanner.dropout_probability = 0.0;
  return settings;
}

/// Scans asked for at 1, 2 and 4 s, over 9 s.
std::vector<Arrival> scans_of(const SensorSuiteSettings& settings, const std::vector<FaultSettings>& faults = {}) {
  return stand(settings, 9.0, faults, make_robot(), test::make_wall_imager,
               {from_seconds(1.0), from_seconds(2.0), from_seconds(4.0)})
      .of<PanoramicScan>();
}

std::string error_text(const SensorSuiteSettings& settings, const std::string& missing_frame) {
  RobotDescription robot = make_robot();
  robot.T_body_sensor.erase(missing_frame);
  try {
    stand(settings, 0.0, {}, robot);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(SensorSuite, TheSensorsOfATrackedRobotAreSilentUnlessAskedFor) {
  EXPECT_TRUE(stand(quiet(), 1.0).arrivals.empty());
}

TEST(SensorSuite, UwbSpeaks25TimesASecondTenMillisecondsLateAndAnchorsTakeTurns) {
  const auto ranges = stand(with_uwb(), 2.009).of<UwbRange>();  // polls at 0, 0.04 ... 1.96; the next is on its way
  ASSERT_EQ(ranges.size(), 50u);
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    EXPECT_EQ(ranges[i].stamp(), from_seconds(0.04 * static_cast<double>(i)));
    EXPECT_NEAR(to_seconds(ranges[i].at - ranges[i].stamp()), 0.01, 0.0021);
    EXPECT_EQ(std::get<UwbRange>(ranges[i].message).anchor, i % 2 == 0 ? 1 : 2);
  }
}

TEST(SensorSuite, TheTransducersFireInTurn40TimesASecondAndHearTheWallTwoAndAHalfMetresAhead) {
  const auto ranges = stand(with_ultrasonic(), 1.009).of<UltrasonicRange>();  // pings at 0, 0.025 ... 0.975
  ASSERT_EQ(ranges.size(), 40u);
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const auto& range = std::get<UltrasonicRange>(ranges[i].message);
    EXPECT_EQ(range.transducer, static_cast<int>(i % 2));
    EXPECT_NEAR(range.range_m, 2.5 * std::sqrt(293.15 / 288.15), 0.03);
    EXPECT_NEAR(to_seconds(ranges[i].at - range.stamp), 0.03, 0.0021);
  }
}

TEST(SensorSuite, TheDepthCameraTakes5FramesASecondAndTheyComeOut50MillisecondsLater) {
  const auto frames =
      stand(with_depth_camera(), 1.049).of<DepthImage>();  // at 0, 0.2 ... 0.8; that of 1 s is on its way
  ASSERT_EQ(frames.size(), 5u);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].stamp(), from_seconds(0.2 * static_cast<double>(i)));
    EXPECT_NEAR(to_seconds(frames[i].at - frames[i].stamp()), 0.05, 0.0021);
    EXPECT_NEAR(std::get<DepthImage>(frames[i].message).depth_mm[2440], 2000, 60);
  }
}

TEST(SensorSuite, ADepthCameraWithoutARendererIsRefusedInASentence) {
  try {
    stand(with_depth_camera(), 0.0, {}, make_robot(), {});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "sensors.depth_camera.enabled = true: requires a renderer, which this command lacks");
  }
}

TEST(SensorSuite, FaultsOfUltrasonicAndDepthCameraAreExecuted) {
  SensorSuiteSettings settings = with_ultrasonic();
  settings.depth_camera = with_depth_camera().depth_camera;
  const Ride ride = stand(settings, 1.0,
                          {fault("ultrasonic", "freeze", 0.1, 0.5), fault("depth_camera", "dropout", 0.1, 0.5),
                           fault("depth_camera", "drift", 0.7, 0.3, 0.5), fault("uwb", "dropout", 0.0, 1.0)});
  EXPECT_TRUE(ride.faults[0].was_triggered);
  EXPECT_TRUE(ride.faults[1].was_triggered);
  EXPECT_TRUE(ride.faults[2].was_triggered);
  EXPECT_FALSE(ride.faults[3].was_triggered);
  const auto frames = ride.of<DepthImage>();  // 0 and 0.6 s, 0.8 s; 0.2 and 0.4 s are silent
  ASSERT_EQ(frames.size(), 3u);
  EXPECT_NEAR(std::get<DepthImage>(frames[2].message).depth_mm[2440], 2050, 60);  // 0.1 s at 0.5 m/s
}

TEST(SensorSuite, AScanIsThereTwoAndAHalfSecondsAfterItIsAskedForAndOneAskedForMeanwhileIsNotTaken) {
  const auto scans = scans_of(with_scanner());
  ASSERT_EQ(scans.size(), 2u);
  EXPECT_EQ(scans[0].stamp(), from_seconds(3.0));
  EXPECT_EQ(scans[0].at, from_seconds(3.5));
  EXPECT_EQ(scans[1].stamp(), from_seconds(6.0));
  EXPECT_GT(std::get<PanoramicScan>(scans[0].message).points.size(), 200u);
}

TEST(SensorSuite, ItIsBusyFor2SecondsAScanAndWithoutAScannerNeverAndNothingComes) {
  EXPECT_EQ(stand(with_scanner(), 5.0, {}, make_robot(), test::make_wall_imager, {from_seconds(1.0)}).busy_ticks, 1000);
  const Ride without = stand(quiet(), 5.0, {}, make_robot(), test::make_wall_imager, {from_seconds(1.0)});
  EXPECT_EQ(without.busy_ticks, 0);
  EXPECT_TRUE(without.arrivals.empty());
}

TEST(SensorSuite, AScannersFaultsAreSilenceDelayAndADriftOfItsRanges) {
  const auto good = scans_of(with_scanner());
  const auto silent = scans_of(with_scanner(), {fault("scanner", "dropout", 0.0, 4.0)});
  ASSERT_EQ(silent.size(), 1u);
  EXPECT_EQ(silent[0].stamp(), from_seconds(6.0));
  EXPECT_EQ(scans_of(with_scanner(), {fault("scanner", "delay", 0.0, 9.0, 1.5)})[0].at, from_seconds(5.0));
  const auto drifted = scans_of(with_scanner(), {fault("scanner", "drift", 1.0, 9.0, 0.01)});
  const auto range = [](const Arrival& scan) {
    const ScannerPoint& p = std::get<PanoramicScan>(scan.message).points.front();
    return std::hypot(p.x, p.y, p.z);
  };
  EXPECT_NEAR(range(drifted[0]) - range(good[0]), 0.01 * (3.0 - 1.0), 1e-5);
  EXPECT_NEAR(range(drifted[1]) - range(good[1]), 0.01 * (6.0 - 1.0), 1e-5);
}

TEST(SensorSuite, AnEnabledSensorWithoutItsFrameIsRefusedByName) {
  EXPECT_EQ(error_text(with_scanner(), "scanner"), "robot carrier: link not found: scanner");
  EXPECT_EQ(error_text(with_uwb(), "uwb"), "robot carrier: link not found: uwb");
  EXPECT_EQ(error_text(with_ultrasonic(), "ultrasonic_0"), "robot carrier: link not found: ultrasonic_0");
  EXPECT_EQ(error_text(with_depth_camera(), "depth_camera"), "robot carrier: link not found: depth_camera");
}

TEST(SensorSuite, EveryFaultOfUwbIsExecutedAndOneOfASilentSensorIsNot) {
  const Ride ride =
      stand(with_uwb(), 2.0,
            {fault("uwb", "dropout", 0.5, 0.1), fault("uwb", "drift", 1.0, 0.5), fault("hall", "dropout", 0.0, 9.0),
             fault("uwb", "outliers", 1.0, 1.0), fault("teleop", "dropout", 0.0, 9.0)});
  ASSERT_EQ(ride.faults.size(), 5u);
  const std::vector<bool> executed = {true, true, false, true, false};
  for (std::size_t i = 0; i < executed.size(); ++i) EXPECT_EQ(ride.faults[i].was_triggered, executed[i]) << i;
}

TEST(SensorSuite, ADriftOf1MetrePerSecondLengthensUwbRangesByTheTimeSinceItsStart) {
  const auto good = stand(with_uwb(), 2.0).of<UwbRange>(),
             bad = stand(with_uwb(), 2.0, {fault("uwb", "drift", 1.0, 5.0)}).of<UwbRange>();
  ASSERT_EQ(good.size(), bad.size());
  for (std::size_t i = 0; i < good.size(); ++i) {
    const double expected = std::max(0.0, to_seconds(good[i].stamp()) - 1.0);
    EXPECT_NEAR(std::get<UwbRange>(bad[i].message).range_m - std::get<UwbRange>(good[i].message).range_m, expected,
                1e-9);
  }
}

TEST(Fault, AClockOffsetOf50MillisecondsMovesStampsAndNotArrivals) {
  const auto good = stand(with_uwb(), 1.0).of<UwbRange>(),
             bad = stand(with_uwb(), 1.0, {fault("uwb", "clock_offset", 0.0, 5.0, 0.05)}).of<UwbRange>();
  ASSERT_EQ(good.size(), bad.size());
  for (std::size_t i = 0; i < good.size(); ++i) {
    EXPECT_EQ(bad[i].at, good[i].at);
    EXPECT_EQ(bad[i].stamp() - good[i].stamp(), from_seconds(0.05));
  }
}

// |N(0, s)| has the mean s sqrt(2 / pi) and the standard deviation s sqrt(1 - 2 / pi); arrivals wait for the next tick:
// 1 ms.
TEST(Fault, JitterOf20MillisecondsDelaysBy16OnAverage) {
  const auto ranges = stand(with_uwb(), 40.0, {fault("uwb", "jitter", 0.0, 50.0, 0.02)}).of<UwbRange>();
  test::Moments delay_s;
  for (const Arrival& range : ranges) delay_s.add(to_seconds(range.at - range.stamp()) - 0.01);
  EXPECT_GT(delay_s.count, 980);
  EXPECT_NEAR(delay_s.mean(), 0.02 * std::sqrt(2.0 / M_PI) + 0.001, 4.0 * 0.02 * 0.603 / std::sqrt(delay_s.count));
}

TEST(SensorSuite, MagnetometerAndBarometerPublishAtTheirRatesWhenSwitchedOnAndAreOffByDefault) {
  SensorSuiteSettings settings = quiet();
  EXPECT_TRUE(stand(settings, 1.0).arrivals.empty());
  settings.magnetometer.enabled = settings.barometer.enabled = true;
  const Ride ride = stand(settings, 1.999, {fault("barometer", "outliers", 0.0, 9.0, 1e6)});
  EXPECT_EQ(ride.of<MagneticField>().size(), 100u);
  EXPECT_EQ(ride.of<FluidPressure>().size(), 10u);
  EXPECT_EQ(ride.of<MagneticField>().front().at, from_seconds(0.01)) << "after its latency";
  RobotDescription robot = make_robot();
  robot.T_body_sensor.erase("imu");
  EXPECT_THROW(stand(settings, 0.1, {}, robot), InputError);
}

AsBuiltSettings clock_only(const ClockTolerances& clock) {
  AsBuiltSettings settings;
  settings.enabled = true;
  settings.clock = clock;
  settings.mounting = {.position_m = 0.0, .angle_deg = 0.0};
  settings.uwb = {.anchor_delay_m = 0.0, .tag_delay_m = 0.0, .received_power_std_db = 0.0};
  return settings;
}

TEST(AsBuilt, ClockOffsetAndDriftChangeStampsAndNotArrivals) {
  const AsBuiltSettings as_built = clock_only({.offset_s = 0.002, .drift_ppm = 500.0, .transport_jitter_s = 0.0});
  const DeviceClock clock = AsBuiltRobot(as_built, make_robot(), 1).clock("uwb");
  ASSERT_NE(clock.offset_s(), 0.0);
  const auto nominal = stand(with_uwb(), 4.0).of<UwbRange>();
  const auto actual = stand(with_uwb(), 4.0, {}, make_robot(), test::make_wall_imager, {}, as_built).of<UwbRange>();
  ASSERT_EQ(actual.size(), nominal.size());
  for (std::size_t i = 1; i < nominal.size(); ++i) {
    EXPECT_EQ(actual[i].at, nominal[i].at);
    const double instant_s = to_seconds(nominal[i].stamp());
    EXPECT_NEAR(to_seconds(actual[i].stamp()) - instant_s, clock.offset_s() + clock.drift() * instant_s, 1e-9);
  }
}

TEST(AsBuilt, TransportJitterDelaysByItsMeanAndKeepsTheOrder) {
  const AsBuiltSettings as_built = clock_only({.offset_s = 0.0, .drift_ppm = 0.0, .transport_jitter_s = 0.02});
  const auto ranges = stand(with_uwb(), 40.0, {}, make_robot(), test::make_wall_imager, {}, as_built).of<UwbRange>();
  test::Moments delay_s;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    delay_s.add(to_seconds(ranges[i].at - ranges[i].stamp()) - 0.01);
    if (i == 0) continue;
    EXPECT_GT(ranges[i].stamp(), ranges[i - 1].stamp());
  }
  // Arrivals wait for the next tick, 1 ms, and for the message before, 40 ms earlier: E[max(0, overtaking)] = 3.3 ms.
  EXPECT_GT(delay_s.mean(), 0.020);
  EXPECT_LT(delay_s.mean(), 0.028);
}

TEST(AsBuilt, AntennaDelaysShiftTheRangesOfEachAnchor) {
  AsBuiltSettings as_built = clock_only({.offset_s = 0.0, .drift_ppm = 0.0, .transport_jitter_s = 0.0});
  as_built.uwb = {.received_power_std_db = 0.0};
  const AsBuiltRobot robot(as_built, make_robot(), 1);
  const auto nominal = stand(with_uwb(), 2.0).of<UwbRange>();
  const auto actual = stand(with_uwb(), 2.0, {}, make_robot(), test::make_wall_imager, {}, as_built).of<UwbRange>();
  ASSERT_EQ(actual.size(), nominal.size());
  for (std::size_t i = 0; i < nominal.size(); ++i) {
    const auto& range = std::get<UwbRange>(actual[i].message);
    EXPECT_NEAR(range.range_m - std::get<UwbRange>(nominal[i].message).range_m, robot.uwb_delay_m(range.anchor), 1e-12);
  }
  EXPECT_NE(robot.uwb_delay_m(1), robot.uwb_delay_m(2));
}

/// A lidar, a 3D lidar and a depth camera, with noise.
SensorSuiteSettings with_expensive_sensors() {
  SensorSuiteSettings settings = quiet();
  settings.lidar.enabled = settings.lidar3d.enabled = settings.depth_camera.enabled = true;
  settings.lidar.beams = 360;
  settings.lidar3d.beams = 90;
  return settings;
}

void expect_same_with_a_thread(const std::vector<FaultSettings>& faults) {
  RobotDescription robot = make_robot();
  robot.T_body_sensor["lidar3d"] = {};
  const auto ride = [&](bool has_thread) {
    return stand(with_expensive_sensors(), 2.0, faults, robot, test::make_wall_imager, {}, {}, has_thread);
  };
  const Ride alone = ride(false), beside = ride(true);
  EXPECT_GT(alone.of<LaserScan>().size(), 5u);
  EXPECT_GT(alone.of<DepthImage>().size(), 5u);
  ASSERT_EQ(alone.arrivals.size(), beside.arrivals.size());
  for (std::size_t i = 0; i < alone.arrivals.size(); ++i) {
    const Arrival &a = alone.arrivals[i], &b = beside.arrivals[i];
    EXPECT_EQ(a.at, b.at);
    EXPECT_EQ(a.stamp(), b.stamp());
    ASSERT_EQ(a.message.index(), b.message.index());
    if (const auto* scan = std::get_if<LaserScan>(&a.message)) {
      EXPECT_EQ(std::memcmp(scan->ranges_m.data(), std::get<LaserScan>(b.message).ranges_m.data(),
                            scan->ranges_m.size() * sizeof(float)),
                0);
    }
    if (const auto* image = std::get_if<DepthImage>(&a.message)) {
      EXPECT_FALSE(image->depth_mm.empty());
      EXPECT_EQ(image->depth_mm, std::get<DepthImage>(b.message).depth_mm);
    }
  }
}

TEST(SensorSuite, MessagesWithAThreadForExpensiveSensorsAreThoseWithout) { expect_same_with_a_thread({}); }

TEST(SensorSuite, MessagesWithAThreadAndFaultsAreThoseWithout) {
  expect_same_with_a_thread({fault("depth_camera", "freeze", 0.5, 0.5), fault("lidar", "outliers", 1.0, 0.5),
                             fault("depth_camera", "dropout", 1.5, 0.2)});
}

}  // namespace
}  // namespace patrol::sim::sensor_suite_test
