#include "stack/sensors/sensor_monitor.h"

#include <functional>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace patrol::stack::sensor_watch_test {
namespace {

constexpr Time kPeriod = std::chrono::milliseconds(100);

LaserScan scan_at(Time stamp, float range_m) {
  LaserScan scan;
  scan.stamp = stamp;
  scan.ranges_m = {range_m, std::numeric_limits<float>::infinity()};
  return scan;
}

/// Ten scans a second while the robot walks ahead at 1 m/s; [call] what was said.
class WatchedWalk {
 public:
  explicit WatchedWalk(const SensorMonitorSettings& settings = {}) : watch(settings) {}

  /// `hear` may be given a scan or none.
  void go_on(double seconds, const std::function<std::optional<LaserScan>(Time)>& scan) {
    for (const Time end = now + from_seconds(seconds); now < end; now += kPeriod) {
      if (const auto heard = scan(now)) watch.receive(*heard, now);
      for (const SensorChange& change : watch.step(now, {to_seconds(now), 0.0, 0.0}, command))
        said.push_back(change.text);
    }
  }

  SensorMonitor watch;
  VelocityCommand command{.stamp = {}, .vx_mps = 1.0};
  Time now = from_seconds(1.0);
  std::vector<std::string> said;
};

std::optional<LaserScan> fresh(Time now) { return scan_at(now, static_cast<float>(to_seconds(now))); }
std::optional<LaserScan> nothing(Time) { return std::nullopt; }

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(SensorMonitor, SaysNothingWhileAllIsWell) {
  WatchedWalk walk;
  walk.go_on(5.0, fresh);
  EXPECT_THAT(walk.said, IsEmpty());
  EXPECT_TRUE(walk.watch.can_drive());
}

TEST(SensorMonitor, HaltsSixTenthsOfASecondAfterTheLastScanAndGoesOnWithTheNext) {
  WatchedWalk walk;
  walk.go_on(1.0, fresh);
  walk.go_on(0.6, nothing);
  EXPECT_TRUE(walk.watch.can_drive());
  walk.go_on(0.2, nothing);
  EXPECT_FALSE(walk.watch.can_drive());
  walk.go_on(0.1, fresh);
  EXPECT_TRUE(walk.watch.can_drive());
  EXPECT_THAT(walk.said, ElementsAre("Sensor lidar timed out.", "Sensor lidar has recovered."));
}

TEST(SensorMonitor, AScanThatComesASecondLateIsAsBadAsNone) {
  WatchedWalk walk;
  walk.go_on(1.0, fresh);
  walk.go_on(1.0, [](Time now) { return fresh(now - from_seconds(1.0)); });
  EXPECT_FALSE(walk.watch.can_drive());
}

TEST(SensorMonitor, AStampOfTheFutureIsAWrongClock) {
  WatchedWalk walk;
  walk.go_on(1.0, fresh);
  walk.go_on(1.0, [](Time now) { return fresh(now + from_seconds(0.2)); });
  EXPECT_FALSE(walk.watch.can_drive());
  EXPECT_THAT(walk.said, ElementsAre("Sensor lidar has timestamps in the future."));
}

// 0.65 s in two hours, more than the lead and the age that are allowed.
TEST(SensorMonitor, AClockThatDriftsBy90PpmForTwoHoursIsNoFaultAndAStepOf100MillisecondsIsOne) {
  for (const double drift : {-9e-5, 9e-5}) {
    WatchedWalk walk;
    const auto drifting = [&](Time now) { return fresh(now + from_seconds(drift * to_seconds(now))); };
    walk.go_on(7200.0, drifting);
    EXPECT_THAT(walk.said, IsEmpty());
    walk.go_on(1.0, [&](Time now) { return drifting(now + from_seconds(0.1)); });
    EXPECT_THAT(walk.said, ElementsAre("Sensor lidar has timestamps in the future."));
  }
}

TEST(SensorMonitor, AClockThatDriftsBy300PpmIsAFaultAfterFourMinutes) {
  WatchedWalk walk;
  const auto drifting = [&](Time now) { return fresh(now + from_seconds(3e-4 * to_seconds(now))); };
  walk.go_on(200.0, drifting);
  EXPECT_THAT(walk.said, IsEmpty());
  walk.go_on(60.0, drifting);
  EXPECT_THAT(walk.said, ElementsAre("Sensor lidar has timestamps in the future."));
}

TEST(SensorMonitor, TheSameScanAgainAndAgainIsFrozenOnceTheRobotHasMoved) {
  WatchedWalk walk;
  walk.go_on(1.0, fresh);
  walk.go_on(0.5, [](Time now) { return scan_at(now, 3.0F); });
  EXPECT_FALSE(walk.watch.can_drive());
  EXPECT_THAT(walk.said, ElementsAre("Sensor lidar is frozen (repeated readings)."));
}

TEST(SensorMonitor, AlikeScansOfARobotAtRestAreNoFault) {
  SensorMonitor watch{{}};
  for (Time now = from_seconds(1.0); now < from_seconds(5.0); now += kPeriod) {
    watch.receive(scan_at(now, 3.0F), now);
    EXPECT_THAT(watch.step(now, {1.0, 2.0, 0.3}, {}), IsEmpty());
  }
}

TEST(SensorMonitor, AnEmptyFieldIsNoFault) {
  WatchedWalk walk;
  walk.go_on(5.0, [](Time now) { return scan_at(now, std::numeric_limits<float>::infinity()); });
  EXPECT_TRUE(walk.watch.can_drive());
}

TEST(SensorMonitor, ASilentImuIsSaidAndDoesNotHalt) {
  WatchedWalk walk;
  Imu imu;
  imu.stamp = walk.now;
  walk.watch.receive(imu, walk.now);
  walk.go_on(1.0, fresh);
  EXPECT_THAT(walk.said, ElementsAre("Sensor imu timed out."));
  EXPECT_TRUE(walk.watch.can_drive());
}

TEST(SensorMonitor, WhatComesFromTheFutureIsNotToBeUsed) {
  SensorMonitor watch{{}};
  const Time now = from_seconds(5.0);
  Imu imu;
  imu.stamp = now + from_seconds(0.04);
  EXPECT_TRUE(watch.receive(imu, now));
  imu.stamp = now + from_seconds(0.2);
  EXPECT_FALSE(watch.receive(imu, now));
  EXPECT_EQ(watch.step(now + from_seconds(0.3), {}, {}).front().text,
            "Sensor imu has timestamps in the future.");  // and stays so until the next message
  EXPECT_TRUE(watch.can_drive());
}

TEST(SensorMonitor, ASensorWhoseFirstMessageCameFromTheFutureIsHeardLikeAnyOther) {
  SensorMonitor watch{{}};
  Imu imu;
  imu.stamp = from_seconds(1.0);
  EXPECT_FALSE(watch.receive(imu, from_seconds(0.5)));
  EXPECT_TRUE(watch.receive(imu, from_seconds(1.0)));
  EXPECT_TRUE(watch.receive(imu, from_seconds(1.0)));
}

// Frozen encoders say that the robot stands, and odometry believes them: that it should move is known from the command
// alone.
TEST(SensorMonitor, EncodersThatRepeatThemselvesHaltTheRobotOnceItShouldHaveMoved) {
  SensorMonitor watch{{}};
  const auto go_on = [&](double vx_mps) {
    for (int i = 0; i < 10; ++i) {
      static Time now = from_seconds(1.0);
      now += std::chrono::milliseconds(50);
      JointState joints;
      joints.stamp = now;
      joints.position_rad = {0.1, 0.2};
      watch.receive(joints, now);
      watch.step(now, {}, {.stamp = {}, .vx_mps = vx_mps});
    }
  };
  go_on(0.0);
  EXPECT_TRUE(watch.can_drive());
  go_on(0.5);
  EXPECT_FALSE(watch.can_drive());
  go_on(0.0);
  EXPECT_FALSE(watch.can_drive());  // it stands now, and they are frozen still
}

TEST(SensorMonitor, ASlowSensorIsNotFrozenBetweenTwoMessages) {
  WatchedWalk walk;
  GnssFix fix;
  walk.go_on(3.0, [&](Time now) {
    if (now - fix.stamp >= from_seconds(0.5)) walk.watch.receive(fix = GnssFix{.stamp = now}, now);
    return fresh(now);
  });
  EXPECT_THAT(walk.said, IsEmpty());
}

TEST(SensorMonitor, WhatWasNeverHeardOfIsNotMissed) {
  SensorMonitor watch{{}};
  EXPECT_THAT(watch.step(from_seconds(100.0), {}, {}), IsEmpty());
}

TEST(SensorMonitor, GivesUpAfterAMinuteWithoutScans) {
  WatchedWalk walk;
  walk.go_on(1.0, fresh);
  walk.go_on(60.0, nothing);
  EXPECT_FALSE(walk.watch.must_abort(walk.now));
  walk.go_on(1.0, nothing);
  EXPECT_TRUE(walk.watch.must_abort(walk.now));
}

}  // namespace
}  // namespace patrol::stack::sensor_watch_test
