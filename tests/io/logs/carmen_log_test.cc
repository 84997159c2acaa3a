#include "io/logs/carmen_log.h"

#include <chrono>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "tests/io/logs/carmen_lines.h"
#include "tests/support/gzip_file.h"
#include "tests/support/pose_near.h"

namespace patrol::io::carmen_log_test {
namespace {

using namespace std::chrono_literals;
using carmen_lines::flaser, carmen_lines::Read, carmen_lines::read, carmen_lines::read_one, carmen_lines::repeated,
    carmen_lines::robotlaser;
using test::gzipped, test::Pose2Near;
using ::testing::ElementsAre, ::testing::HasSubstr, ::testing::Pair, ::testing::UnorderedElementsAre;

constexpr double kExactTol = 1e-12;
constexpr double kRoundedPi = 3.141593;  // as logs write it

TEST(CarmenLog, ReadsFlaserWithItsStampRangesAndOdometry) {
  const RecordedScan scan = read_one("# a comment\n" + flaser("976052857.222433", "1 2 0.5", "1 2 0.5"));
  EXPECT_EQ(scan.scan.stamp, Time(976'052'857'222'433'000)) << "the ipc_timestamp, not the logger's";
  EXPECT_THAT(scan.scan.ranges_m, ElementsAre(1.0F, 2.0F, 3.0F, 4.0F));
  EXPECT_THAT(scan.T_odom_body, Pose2Near(Pose2{1.0, 2.0, 0.5}, kExactTol, kExactTol));
  EXPECT_THAT(scan.T_body_lidar, Pose2Near(Pose2{}, 0.0, 0.0));
  EXPECT_EQ(scan.scan.range_max_m, 80.0);
}

TEST(CarmenLog, ReadsGzipAsThePlainFile) {
  const std::string text = flaser("1") + flaser("2") + flaser("3");
  const Read packed = read(gzipped(text));
  ASSERT_EQ(packed.scans.size(), 3U);
  EXPECT_EQ(packed.scans[2].scan.stamp, 3s);
}

TEST(CarmenLog, AnEvenNumberOfOldBeamsStartsAtMinusNinetyAndEndsAStepBeforeNinety) {
  for (const int n : {180, 360}) {
    const LaserScan scan = read_one(flaser("1", "0 0 0", "0 0 0", std::to_string(n) + repeated("1", n))).scan;
    EXPECT_NEAR(scan.angle_min_rad, -90.0 * kDegree, kExactTol);
    EXPECT_NEAR(scan.angle_increment_rad, 180.0 / n * kDegree, kExactTol);
  }
}

TEST(CarmenLog, AnOddNumberOfOldBeamsEndsAtNinety) {
  for (const int n : {181, 361}) {
    const LaserScan scan = read_one(flaser("1", "0 0 0", "0 0 0", std::to_string(n) + repeated("1", n))).scan;
    EXPECT_NEAR(scan.angle_min_rad, -90.0 * kDegree, kExactTol);
    EXPECT_NEAR(scan.angle_min_rad + (n - 1) * scan.angle_increment_rad, 90.0 * kDegree, kExactTol);
  }
}

TEST(CarmenLog, TheResolutionParameterNarrowsTheFieldOfView) {
  // A SICK LMS at 0.25 deg has 401 beams over 100 deg.
  const LaserScan scan = read_one("PARAM laser_front_laser_resolution 0.25 0 host 0\n" +
                                  flaser("1", "0 0 0", "0 0 0", "401" + repeated("1", 401)))
                             .scan;
  EXPECT_NEAR(scan.angle_increment_rad, 0.25 * kDegree, kExactTol);
  EXPECT_NEAR(scan.angle_min_rad, -50.0 * kDegree, kExactTol);
}

TEST(CarmenLog, AnImpossibleResolutionParameterIsNotFollowed) {
  for (const char* const resolution : {"0", "-1", "4"}) {  // 180 beams at 4 deg: two turns
    const LaserScan scan = read_one(fmt::format("PARAM laser_front_laser_resolution {}\n", resolution) +
                                    flaser("1", "0 0 0", "0 0 0", "180" + repeated("1", 180)))
                               .scan;
    EXPECT_NEAR(scan.angle_increment_rad, kDegree, kExactTol) << resolution;
  }
}

TEST(CarmenLog, AnOldMessageOf1081BeamsIsAHokuyosOver270Degrees) {
  const LaserScan scan = read_one(flaser("1", "0 0 0", "0 0 0", "1081" + repeated("1", 1081))).scan;
  EXPECT_NEAR(scan.angle_min_rad, -135.0 * kDegree, kExactTol);
  EXPECT_NEAR(scan.angle_increment_rad, 0.25 * kDegree, kExactTol);
}

TEST(CarmenLog, ReadsRobotlaserWithItsOwnAngles) {
  const RecordedScan scan = read_one(robotlaser("0 -1.570796 3.141593 0.017453 81.92 0.01 0", 181));
  EXPECT_EQ(scan.scan.stamp, 10s + 250ms);
  EXPECT_EQ(scan.scan.ranges_m.size(), 181U);
  EXPECT_NEAR(scan.scan.angle_min_rad, -1.570796, kExactTol);
  EXPECT_NEAR(scan.scan.angle_increment_rad, kRoundedPi / 180.0, kExactTol)
      << "exact where the field of view says more than six digits";
  EXPECT_TRUE(scan.scan.intensities.empty());
}

TEST(CarmenLog, RobotlasersFieldOfViewMayCountBeamsOrGapsOrNeither) {
  EXPECT_NEAR(read_one(robotlaser("0 -1.570796 3.141593 0.017453 80 0 0", 180)).scan.angle_increment_rad,
              kRoundedPi / 180.0, kExactTol);
  EXPECT_NEAR(read_one(robotlaser("0 -1 2 0.01 80 0 0", 10)).scan.angle_increment_rad, 0.01, kExactTol);
  EXPECT_NEAR(read_one(robotlaser("0 -1 2 0 80 0 0", 11)).scan.angle_increment_rad, 0.2, kExactTol);
}

TEST(CarmenLog, RobotlasersRemissionsAreIntensities) {
  EXPECT_THAT(read_one(robotlaser("0 -1 2 1 80 0 0", 3, "0 0 0 0 0 0", "3 7 8 9.5")).scan.intensities,
              ElementsAre(7.0F, 8.0F, 9.5F));
  EXPECT_TRUE(read_one(robotlaser("0 -1 2 1 80 0 0", 3, "0 0 0 0 0 0", "2 7 8")).scan.intensities.empty())
      << "not one a beam";
}

TEST(CarmenLog, RangesFromTheSensorsMaximumOnAreNoReturns) {
  const auto old = read_one(flaser("1", "0 0 0", "0 0 0", "8 79.99 80 81.83 1e30 inf 0 -1 nan")).scan.ranges_m;
  const float inf = std::numeric_limits<float>::infinity();
  EXPECT_EQ(old[0], 79.99F);
  for (const std::size_t beam : {1U, 2U, 3U, 4U}) EXPECT_EQ(old[beam], inf);
  for (const std::size_t beam : {5U, 6U, 7U}) EXPECT_TRUE(std::isnan(old[beam]));
  const LaserScan short_range =
      read_one("ROBOTLASER1 0 -1 2 1 8.1 0 0 3 8.09 8.1 50 0 0 0 0 0 0 0 0 0 0 0 0 1 host 1\n").scan;
  EXPECT_THAT(short_range.ranges_m, ElementsAre(8.09F, inf, inf));
  EXPECT_EQ(short_range.range_max_m, 8.1);
  EXPECT_EQ(read_one("ROBOTLASER1 0 -1 2 1 0 0 0 3 8.09 8.1 50 0 0 0 0 0 0 0 0 0 0 0 0 1 host 1\n").scan.range_max_m,
            80.0)
      << "a maximum of 0 says nothing";
}

TEST(CarmenLog, TheLidarPoseIsRelativeToTheRobotPose) {
  // The robot at (1, 2) looks along y; the lidar 0.3 m before it.
  const RecordedScan scan = read_one(flaser("1", "1 2.3 1.570796", "1 2 1.570796"));
  EXPECT_THAT(scan.T_odom_body, Pose2Near(Pose2{1.0, 2.0, 1.570796}, kExactTol, kExactTol))
      << "the second pose is the robot's";
  EXPECT_THAT(scan.T_body_lidar, Pose2Near(Pose2{0.3, 0.0, 0.0}, 1e-6, kExactTol));
}

TEST(CarmenLog, WithEqualPosesTheParameterGivesTheLidarPose) {
  const std::string parameters =
      "PARAM robot_frontlaser_offset 0.08 0 host 0\nPARAM robot_frontlaser_side_offset -0.02\nPARAM "
      "robot_frontlaser_angular_offset 0.01\n";
  EXPECT_THAT(read_one(parameters + flaser("1")).T_body_lidar,
              Pose2Near(Pose2{0.08, -0.02, 0.01}, kExactTol, kExactTol));
}

TEST(CarmenLog, ACorrectedFirstPoseIsNotFollowed) {
  // The second pose is the odometry; the first was corrected afterwards and wanders off.
  const Read result =
      read(flaser("1", "0 0 0", "0 0 0") + flaser("2", "1 0 0", "1.5 0 0.1") + flaser("3", "2 1 0", "3 0 0.2"));
  for (const RecordedScan& scan : result.scans) EXPECT_THAT(scan.T_body_lidar, Pose2Near(Pose2{}, 0.0, 0.0));
  EXPECT_THAT(result.scans[2].T_odom_body, Pose2Near(Pose2{3.0, 0.0, 0.2}, kExactTol, kExactTol));
  EXPECT_THAT(result.summary.assumed, ElementsAre(Pair("scans: lidar pose of the first scan", 2U)));
  EXPECT_THAT(read_one(flaser("1", "50 0 0", "0 0 0")).T_body_lidar, Pose2Near(Pose2{}, 0.0, 0.0))
      << "no lidar sits 50 m before its robot";
}

TEST(CarmenLog, TheRearLidarLooksBackAndItsOffsetCountsBackwards) {
  std::string line = flaser("1");
  line.front() = 'R';
  EXPECT_THAT(read_one("PARAM robot_rearlaser_offset 0.2 0 host 0\n" + line).T_body_lidar,
              Pose2Near(Pose2{-0.2, 0.0, std::numbers::pi}, kExactTol, kExactTol));
}

TEST(CarmenLog, RawlaserTakesTheNewestOdomBeforeIt) {
  const std::string raw = "RAWLASER1 0 -1 2 1 80 0 0 3 1 2 3 0 {} host 1\n";
  const std::string text = fmt::format(fmt::runtime(raw), 1) + "ODOM 1 2 0.5 0 0 0 1.5 host 1\n" +
                           fmt::format(fmt::runtime(raw), 2) + "ODOM 3 4 0.6 0 0 0 2.5 host 1\n" +
                           fmt::format(fmt::runtime(raw), 3);
  const Read result = read(text);
  ASSERT_EQ(result.scans.size(), 2U);
  EXPECT_THAT(result.scans[0].T_odom_body, Pose2Near(Pose2{1.0, 2.0, 0.5}, kExactTol, kExactTol));
  EXPECT_THAT(result.scans[1].T_odom_body, Pose2Near(Pose2{3.0, 4.0, 0.6}, kExactTol, kExactTol));
  EXPECT_THAT(result.summary.skipped, ElementsAre(Pair("scans before the first ODOM", 1U)));
}

TEST(CarmenLog, UsedOdomIsNotIgnored) {
  const Read result = read("ODOM 1 2 0.5 0 0 0 0.5 host 0\nRAWLASER1 0 -1 2 1 80 0 0 3 1 2 3 0 1 host 1\n");
  EXPECT_TRUE(result.summary.ignored.empty());
}

TEST(CarmenLog, ARearLidarIsNamed) {
  std::string line = flaser("1");
  line.front() = 'R';
  EXPECT_THAT(read(line).summary.found, ElementsAre("RLASER is the rear laser of CARMEN: it looks backward "
                                                    "(log.carmen_laser)"));
}

/// Scans of 100 beams with one range each, every `step_s`.
std::string uniform_scans(int count, double range_m, double step_s) {
  std::string text;
  for (int i = 0; i < count; ++i) {
    text += "FLASER 100";
    for (int beam = 0; beam < 100; ++beam) text += fmt::format(" {}", range_m);
    text += fmt::format(" 0 0 0 0 0 0 {} host {}\n", step_s * i, step_s * i);
  }
  return text;
}

TEST(CarmenLog, RangesInCentimetersAndStampsInMillisecondsAreHintedAt) {
  EXPECT_EQ(to_text(read(uniform_scans(20, 3.0, 0.2)).summary), "20 scans\n");
  EXPECT_THAT(to_text(read(uniform_scans(20, 300.0, 0.2)).summary),
              HasSubstr("warning: only 0.0 % of the beams have a return: ranges must be in meters"));
  EXPECT_THAT(to_text(read(uniform_scans(20, 3.0, 200.0)).summary),
              HasSubstr("warning: the scans are 200 s apart on average: stamps must be in seconds"));
}

TEST(CarmenLog, OfSeveralLidarsTheMostInformativeOrTheSelectedOneIsUsed) {
  std::string rear = flaser("3");
  rear.front() = 'R';
  const std::string text = "ODOM 9 9 0 0 0 0 0 host 0\nRAWLASER1 0 -1 2 1 80 0 0 3 1 2 3 0 5 host 1\n" + rear +
                           flaser("1") + robotlaser("0 -1 2 1 80 0 0", 3);
  EXPECT_EQ(read_one(text).scan.stamp, 10s + 250ms);
  ScanLogOptions options;
  options.carmen_laser = "RLASER";
  const Read result = read(text, options);
  EXPECT_EQ(result.scans.front().scan.stamp, 3s);
  EXPECT_THAT(result.summary.ignored, UnorderedElementsAre(Pair("ODOM", 1U), Pair("RAWLASER1", 1U), Pair("FLASER", 1U),
                                                           Pair("ROBOTLASER1", 1U)));
}

TEST(CarmenLog, OtherMessagesAreIgnoredAndCounted) {
  const Read result = read("SYNC start 1 host 1\n" + flaser("1") +
                           "TRUEPOS 0 0 0 0 0 0 1 host 1\n\n# c\nSYNC end 2 host 2\nWIFI-SCAN what ever\n\r\n");
  EXPECT_THAT(result.summary.ignored, ElementsAre(Pair("SYNC", 2U), Pair("TRUEPOS", 1U), Pair("WIFI-SCAN", 1U)));
  EXPECT_TRUE(result.summary.skipped.empty());
  EXPECT_EQ(result.summary.num_read, 8U);
  EXPECT_EQ(to_text(result.summary), "1 scans\nignored: 2 SYNC, 1 TRUEPOS, 1 WIFI-SCAN\n");
}

TEST(CarmenLog, LinesOutOfOrderArePutInOrderAndEqualStampsKept) {
  const Read result = read(flaser("3") + flaser("1") + flaser("2", "5 5 0", "5 5 0") + flaser("2", "6 6 0", "6 6 0"));
  std::vector<Time> stamps;
  std::vector<double> x;
  for (const RecordedScan& scan : result.scans) {
    stamps.push_back(scan.scan.stamp);
    x.push_back(scan.T_odom_body.x);
  }
  EXPECT_THAT(stamps, ElementsAre(1s, 2s, 2s, 3s));
  EXPECT_THAT(x, ElementsAre(1, 5, 6, 1));
  EXPECT_EQ(result.summary.num_reordered, 3U);
  EXPECT_EQ(result.summary.num_same_stamp, 1U);
}

TEST(CarmenLog, AtMostFiftyNamesAreCountedSeparately) {
  std::string text = flaser("1");
  for (int i = 0; i < 100; ++i) text += fmt::format("NAME{} 1\n", i);
  const Read result = read(text);
  EXPECT_EQ(result.summary.ignored.size(), 51U);
  EXPECT_EQ(result.summary.ignored.at("others"), 50U);
}

TEST(ScanLogOptions, AnUnknownLaserIsRefused) {
  ScanLogOptions options;
  options.carmen_laser = "SONAR";
  try {
    open_scan_log("a.log", options);
    FAIL() << "must throw";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("log.carmen_laser = SONAR: must be one of "));
  }
}

}  // namespace
}  // namespace patrol::io::carmen_log_test
