#include "io/logs/mcap_scan_log.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "io/logs/run_log.h"
#include "tests/io/log_messages.h"
#include "tests/support/pose_near.h"
#include "tests/support/temporary_file.h"

namespace patrol::io::mcap_scan_log_test {
namespace {

using namespace std::chrono_literals;
using test::MessageFile, test::odometry_at, test::placed, test::scan_at;
using test::Pose2Near, test::read_bytes, test::TemporaryFolder, test::write_bytes;
using ::testing::ElementsAre, ::testing::EndsWith, ::testing::HasSubstr, ::testing::Pair;

constexpr double kExactTol = 1e-12;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct Read {
  std::vector<RecordedScan> scans;
  ScanLogSummary summary;
};

class McapScans : public ::testing::Test {
 protected:
  Read read(const ScanLogOptions& options = {}) {
    const std::unique_ptr<ScanLog> log = open_scan_log(file, options);
    Read result;
    while (std::optional<RecordedScan> scan = log->next()) result.scans.push_back(std::move(*scan));
    EXPECT_EQ(log->progress(), 1.0);
    result.summary = log->summary();
    return result;
  }
  std::string complaint(const ScanLogOptions& options = {}) {
    try {
      read(options);
    } catch (const InputError& error) {
      const std::string what = error.what();
      return what.substr(what.find("log.mcap"));
    }
    return "";
  }

  TemporaryFolder folder;
  const std::filesystem::path file = folder / "log.mcap";
  MessageFile writer{file};
};

TEST_F(McapScans, OdometryIsInterpolatedToTheScansStamp) {
  writer.write("/odom", 1s, odometry_at(1s));
  writer.write("/scan", 1300ms, scan_at(1250ms));
  writer.write("/odom", 2s, odometry_at(2s));
  writer.close();
  const Read result = read();
  ASSERT_EQ(result.scans.size(), 1U);
  EXPECT_EQ(result.scans[0].scan.stamp, 1250ms);
  EXPECT_THAT(result.scans[0].T_odom_body, Pose2Near(Pose2{1.25, 0.0, 0.0}, kExactTol, kExactTol));
  EXPECT_THAT(result.scans[0].scan.ranges_m, ElementsAre(1.0F, 2.0F, 3.0F));
  EXPECT_EQ(result.scans[0].scan.angle_min_rad, -0.5);
  EXPECT_THAT(result.summary.assumed, ElementsAre(Pair(HasSubstr("body origin"), 1U)));
}

TEST_F(McapScans, WhereBeamsHaveTimesTheMotionFromTheFirstToTheLastIsGiven) {
  LaserScan scan = scan_at(1250ms);
  scan.time_increment_s = 0.1;  // three beams: 0.2 s at 1 m/s
  LaserScan last = scan_at(1900ms);
  last.time_increment_s = 0.1;  // odometry ends before it does
  writer.write("/odom", 1s, odometry_at(1s));
  writer.write("/scan", 1300ms, scan);
  writer.write("/scan", 1950ms, last);
  writer.write("/odom", 2s, odometry_at(2s));
  writer.close();
  const Read result = read();
  ASSERT_EQ(result.scans.size(), 2U);
  EXPECT_THAT(result.scans[0].T_odom_body, Pose2Near(Pose2{1.25, 0.0, 0.0}, kExactTol, kExactTol));
  EXPECT_THAT(result.scans[0].T_begin_end, Pose2Near(Pose2{0.2, 0.0, 0.0}, 1e-6, 1e-6));  // float32 in the message
  EXPECT_THAT(result.scans[1].T_begin_end, Pose2Near(Pose2{}, kExactTol, kExactTol));
}

TEST_F(McapScans, WithoutAnOdometryTopicTfIsTakenOverItsFramesBetween) {
  for (const Time t : {1s, 2s}) {
    writer.write(
        "/tf", t,
        TransformSet{{placed("odom", "base_footprint", {{to_seconds(t), 0.0, 0.0}, quaternion_from_yaw(0.5)}, t),
                      placed("base_footprint", "base_link", {{0.0, 0.0, 0.4}, Eigen::Quaterniond::Identity()}, t)}});
    if (t == 1s) writer.write("/scan", 1500ms, scan_at(1500ms));
  }
  writer.close();
  EXPECT_THAT(read().scans.at(0).T_odom_body, Pose2Near(Pose2{1.5, 0.0, 0.5}, kExactTol, kExactTol));
}

TEST_F(McapScans, TheFirstSourceIsKept) {
  writer.write("/tf", 0s, TransformSet{{placed("odom", "base_link", {}, 0s)}});
  writer.write("/scan", 500ms, scan_at(500ms));
  writer.write("/tf", 1s, TransformSet{{placed("odom", "base_link", {}, 1s)}});
  writer.write("/odom", 1s, odometry_at(1s));
  writer.write("/scan", 1500ms, scan_at(1500ms));
  writer.write("/tf", 2s, TransformSet{{placed("odom", "base_link", {}, 2s)}});
  writer.write("/odom", 2s, odometry_at(2s));
  writer.write("/scan", 2500ms, scan_at(2500ms));
  writer.write("/tf", 3s, TransformSet{{placed("odom", "base_link", {}, 3s)}});
  writer.write("/odom", 3s, odometry_at(3s));
  writer.close();
  const Read result = read();
  ASSERT_EQ(result.scans.size(), 3U);
  for (const RecordedScan& scan : result.scans) EXPECT_EQ(scan.T_odom_body.x, 0.0) << "tf's, not the topic's";
}

TEST_F(McapScans, TheLidarPoseIsThePlanarPartOfTfStatic) {
  writer.write(
      "/tf_static", 0s,
      TransformSet{{placed("base_link", "plate", {{0.1, 0.0, 0.5}, quaternion_from_yaw(std::numbers::pi / 2.0)}),
                    placed("plate", "lidar", {{0.2, 0.0, 0.0}, Eigen::Quaterniond::Identity()})}});
  writer.write("/odom", 0s, odometry_at(0s));
  writer.write("/scan", 1s, scan_at(500ms));
  writer.write("/odom", 1s, odometry_at(1s));
  writer.close();
  const Read result = read();
  EXPECT_THAT(result.scans.at(0).T_body_lidar,
              Pose2Near(Pose2{0.1, 0.2, std::numbers::pi / 2.0}, kExactTol, kExactTol));
  EXPECT_TRUE(result.summary.assumed.empty());
}

TEST_F(McapScans, ALidarUpsideDownRotatesTheOppositeWay) {
  writer.write("/tf_static", 0s,
               TransformSet{{placed("base_link", "lidar",
                                    {{0.1, 0.0, 0.5}, quaternion_from_rpy(std::numbers::pi, 0.0, 0.25)})}});
  writer.write("/odom", 0s, odometry_at(0s));
  writer.write("/scan", 1s, scan_at(500ms));
  writer.write("/odom", 1s, odometry_at(1s));
  writer.close();
  const RecordedScan scan = read().scans.at(0);
  EXPECT_THAT(scan.T_body_lidar, Pose2Near(Pose2{0.1, 0.0, 0.25}, kExactTol, kExactTol));
  EXPECT_EQ(scan.scan.angle_min_rad, 0.5);
  EXPECT_EQ(scan.scan.angle_increment_rad, -0.25);
}

TEST_F(McapScans, TheGroundTruthIsNotTheRobotsOdometry) {
  for (const Time t : {0s, 1s}) {
    writer.write(
        "/ground_truth/odom", t,
        GroundTruth{.stamp = t, .T_world_body = {{99.0, 0.0, 0.0}, Eigen::Quaterniond::Identity()}, .twist = {}});
    writer.write("/odom", t, odometry_at(t));
    if (t == 0s) writer.write("/scan", t, scan_at(500ms));
  }
  writer.close();
  const Read result = read();
  EXPECT_EQ(result.scans.at(0).T_odom_body.x, 0.5);
  EXPECT_THAT(result.summary.ignored, ElementsAre(Pair("/ground_truth/odom", 2U)));
}

TEST_F(McapScans, TopicsCanBeAskedFor) {
  for (const Time t : {0s, 1s}) {
    writer.write("/odom", t, odometry_at(t));
    writer.write("/visual_odom", t, odometry_at(t, 10.0));
    if (t == 0s) writer.write("/front/scan", t, scan_at(250ms));
    if (t == 0s) writer.write("/rear/scan", t, scan_at(500ms));
  }
  writer.close();
  EXPECT_EQ(read().scans.at(0).scan.stamp, 250ms) << "the first, unless asked otherwise";
  ScanLogOptions options;
  options.scan_topic = "/rear/scan";
  options.odometry_topic = "/visual_odom";
  const Read result = read(options);
  ASSERT_EQ(result.scans.size(), 1U);
  EXPECT_EQ(result.scans[0].scan.stamp, 500ms);
  EXPECT_EQ(result.scans[0].T_odom_body.x, 10.5);
  EXPECT_THAT(result.summary.ignored, ElementsAre(Pair("/front/scan", 1U), Pair("/odom", 2U)));
}

TEST_F(McapScans, ScansOutsideTheOdometrysTimeAreSkippedAndCounted) {
  writer.write("/scan", 0s, scan_at(500ms));
  writer.write("/odom", 1s, odometry_at(1s));
  writer.write("/scan", 1s, scan_at(1500ms));
  writer.write("/odom", 2s, odometry_at(2s));
  writer.write("/scan", 2s, scan_at(2500ms));
  writer.close();
  const Read result = read();
  ASSERT_EQ(result.scans.size(), 1U);
  EXPECT_EQ(result.scans[0].scan.stamp, 1500ms);
  EXPECT_THAT(result.summary.skipped, ElementsAre(Pair("scans without odometry", 2U)));
  EXPECT_THAT(result.summary.warnings.at(0), EndsWith("log.mcap: no odometry at the stamp of the scan, 0.500000000 s"));
}

TEST_F(McapScans, RangesAreTidiedAsRep117Asks) {
  writer.write("/odom", 0s, odometry_at(0s));
  writer.write("/scan", 0s, scan_at(500ms, {29.9F, 30.0F, 65.5F, kInfinity, 0.49F, 0.0F, -1.0F, NAN, -kInfinity}));
  writer.write("/odom", 1s, odometry_at(1s));
  writer.close();
  const std::vector<float> ranges = read().scans.at(0).scan.ranges_m;
  EXPECT_EQ(ranges[0], 29.9F);
  for (const std::size_t beam : {1U, 2U, 3U}) EXPECT_EQ(ranges[beam], kInfinity) << beam;
  for (const std::size_t beam : {4U, 8U}) EXPECT_EQ(ranges[beam], -kInfinity) << beam;
  for (const std::size_t beam : {5U, 6U, 7U}) EXPECT_TRUE(std::isnan(ranges[beam])) << beam;
}

TEST_F(McapScans, PatrolsOwnRunLogsAreRead) {
  RobotDescription robot;
  robot.T_body_sensor["lidar"] = {{0.2, 0.0, 0.1}, quaternion_from_yaw(0.1)};
  const std::filesystem::path run_log = folder / "run.mcap";
  RunLogWriter run(run_log, robot);
  for (int i = 0; i < 100; ++i) {
    const Time now = i * 100ms;
    run.write(now, GroundTruth{
                       .stamp = now, .T_world_body = {{50.0, 0.0, 0.0}, Eigen::Quaterniond::Identity()}, .twist = {}});
    run.write(now, odometry_at(now));
    run.write(now, scan_at(now + 50ms));
  }
  run.close();
  const std::unique_ptr<ScanLog> log = open_scan_log(run_log);
  int count = 0;
  while (const auto scan = log->next()) {
    EXPECT_EQ(scan->scan.stamp, count * 100ms + 50ms);
    EXPECT_THAT(scan->T_odom_body, Pose2Near(Pose2{0.1 * count + 0.05, 0.0, 0.0}, kExactTol, kExactTol));
    EXPECT_THAT(scan->T_body_lidar, Pose2Near(Pose2{0.2, 0.0, 0.1}, kExactTol, kExactTol));
    ++count;
  }
  EXPECT_EQ(count, 99) << "the last has no odometry after it";
}

/// A robot stands for 3 s and then turns on the spot by 0.5 rad/s for 12 s, of which its odometry makes
/// `odometry_scale` times as much. Its gyro hangs upside down and has a bias of 0.03 rad/s about its own axis.
void turn_with_gyro(MessageFile& writer, double odometry_scale, bool has_place = true) {
  if (has_place)
    writer.write(
        "/tf_static", 0s,
        TransformSet{{placed("base_link", "imu", {{0.0, 0.0, 0.0}, quaternion_from_rpy(std::numbers::pi, 0.0, 0.0)})}});
  for (int tick = 0; tick <= 1500; ++tick) {
    const Time now = tick * 10ms;
    const double rate = tick >= 300 ? 0.5 : 0.0, yaw = std::max(0.0, 0.5 * (to_seconds(now) - 3.0));
    writer.write("/imu/data", now, Imu{.stamp = now, .angular_velocity_radps = {0.0, 0.0, -rate + 0.03}});
    if (tick % 5 == 0) {
      OdometryEstimate odometry;
      odometry.stamp = now;
      odometry.T_odom_body.rotation = quaternion_from_yaw(odometry_scale * yaw);
      writer.write("/odom", now, odometry);
    }
    if (tick % 20 == 10) writer.write("/scan", now, scan_at(now));
  }
  writer.close();
}
constexpr double kLastScanTurnRad = 0.5 * (14.9 - 3.0);

// The trapezoid over the jump from standing to 0.5 rad/s, 10 ms, adds 0.0025 rad.
ScanLogOptions with_imu(const std::string& imu) {
  ScanLogOptions options;
  options.imu = imu;
  options.detect_no_return = false;  // every scan of these files is the same
  return options;
}

TEST_F(McapScans, OdometryThatContradictsTheGyroUsesTheGyroYawWithoutItsBias) {
  turn_with_gyro(writer, 1.2);
  const Read result = read(with_imu("auto"));
  EXPECT_NEAR(wrap_angle(result.scans.back().T_odom_body.yaw - kLastScanTurnRad), 0.0, 0.003);
  EXPECT_THAT(
      result.summary.found,
      ElementsAre("odometry yaw replaced by the gyro of /imu/data: bias -0.03000 rad/s from 3 s at rest (log.imu)"));
  const Read wheels = read(with_imu("off"));
  EXPECT_NEAR(wrap_angle(wheels.scans.back().T_odom_body.yaw - 1.2 * kLastScanTurnRad), 0.0, 1e-6);
  EXPECT_THAT(wheels.summary.ignored, ElementsAre(Pair("/imu/data", 1501U)));
}

TEST_F(McapScans, OdometryThatAgreesWithTheGyroIsKeptUnlessRequested) {
  turn_with_gyro(writer, 1.0);
  const Read kept = read(with_imu("auto"));
  EXPECT_NEAR(wrap_angle(kept.scans.back().T_odom_body.yaw - kLastScanTurnRad), 0.0, 1e-6);
  EXPECT_THAT(kept.summary.found, ElementsAre("odometry yaw agrees with the gyro: odometry kept unchanged (log.imu)"));
  EXPECT_THAT(read(with_imu("on")).summary.found, ElementsAre(HasSubstr("yaw replaced by the gyro of /imu/data")));
}

TEST_F(McapScans, AGyroWithOppositeSignIsNotUsed) {
  turn_with_gyro(writer, 1.2, false);  // nothing says that it hangs upside down
  const Read result = read(with_imu("auto"));
  EXPECT_NEAR(wrap_angle(result.scans.back().T_odom_body.yaw - 1.2 * kLastScanTurnRad), 0.0, 1e-6);
  EXPECT_THAT(result.summary.found, ElementsAre(HasSubstr("uncorrelated")));
  EXPECT_THAT(read(with_imu("on")).summary.assumed, ::testing::Contains(Pair(HasSubstr("IMU mounted level"), 1501U)));
}

TEST_F(McapScans, OrderAndEqualStampsAreAsInTextLogs) {
  writer.write("/odom", 0s, odometry_at(0s));
  for (const Time stamp : {300ms, 100ms, 200ms, 200ms}) writer.write("/scan", 1s, scan_at(stamp));
  writer.write("/odom", 1s, odometry_at(1s));
  writer.close();
  const Read result = read();
  std::vector<Time> stamps;
  for (const RecordedScan& scan : result.scans) stamps.push_back(scan.scan.stamp);
  EXPECT_THAT(stamps, ElementsAre(100ms, 200ms, 200ms, 300ms));
  EXPECT_EQ(result.summary.num_reordered, 3U);
  EXPECT_EQ(result.summary.num_same_stamp, 1U);
}

TEST_F(McapScans, AScanTooLateToPutInOrderIsRefusedOrSkipped) {
  writer.write("/odom", 0s, odometry_at(0s));
  writer.write("/odom", 5s, odometry_at(5s));
  for (int i = 1; i <= 40; ++i) writer.write("/scan", 5s, scan_at(i * 100ms));
  writer.write("/scan", 6s, scan_at(50ms));
  writer.close();
  EXPECT_EQ(complaint(),
            "log.mcap: /scan: stamp 0.050000 s after 0.800000 s, more than 32 scans late: cannot be sorted");
  ScanLogOptions options;
  options.skip_invalid = true;
  EXPECT_EQ(read(options).scans.size(), 40U);
}

TEST_F(McapScans, MessagesThatCannotBeReadAreRefusedOrSkipped) {
  ScanLogOptions skip;
  skip.skip_invalid = true;
  writer.write("/odom", 0s, odometry_at(0s));
  writer.write("/scan", 0s, scan_at(500ms));
  const std::string whole = encode(scan_at(600ms));
  writer.write_cdr("/scan", kRosType<LaserScan>, 1s, whole.substr(0, whole.size() - 9));
  writer.write("/odom", 1s, odometry_at(1s));
  writer.close();
  EXPECT_THAT(complaint(), HasSubstr("log.mcap: /scan at 1.000000000 s: not a sensor_msgs/msg/LaserScan: "));
  const Read result = read(skip);
  EXPECT_EQ(result.scans.size(), 1U);
  EXPECT_THAT(result.summary.skipped, ElementsAre(Pair("unreadable messages", 1U)));
}

TEST_F(McapScans, ScansAndPosesThatAreNoneAreNamed) {
  const auto complaint_about = [&](const auto& topic, const auto& message) {
    const std::filesystem::path bad = folder / "bad.mcap";
    MessageFile one(bad);
    one.write(topic, 1s, message);
    one.close();
    try {
      open_scan_log(bad)->next();
    } catch (const InputError& error) {
      const std::string what = error.what();
      return what.substr(what.find("bad.mcap"));
    }
    return std::string();
  };
  LaserScan wide = scan_at(0s);
  wide.angle_increment_rad = 3.0;
  LaserScan timeless = scan_at(0s);
  timeless.scan_time_s = NAN;
  OdometryEstimate lost = odometry_at(0s);
  lost.T_odom_body.position.x() = NAN;
  OdometryEstimate unturned = odometry_at(0s);
  unturned.T_odom_body.rotation.coeffs().setZero();
  EXPECT_EQ(complaint_about("/scan", scan_at(0s, {})),
            "bad.mcap: /scan at 1.000000000 s: scan with 0 beams: must be in [1, 10000]");
  EXPECT_EQ(complaint_about("/scan", scan_at(0s, std::vector<float>(10'001, 1.0F))),
            "bad.mcap: /scan at 1.000000000 s: scan with 10001 beams: must be in [1, 10000]");
  EXPECT_EQ(complaint_about("/scan", wide), "bad.mcap: /scan at 1.000000000 s: scan angles exceed one revolution");
  EXPECT_EQ(complaint_about("/scan", timeless), "bad.mcap: /scan at 1.000000000 s: scan times must be finite");
  EXPECT_EQ(complaint_about("/odom", lost),
            "bad.mcap: /odom at 1.000000000 s: odometry: invalid pose: must be finite, with a unit quaternion");
  EXPECT_EQ(complaint_about("/odom", unturned),
            "bad.mcap: /odom at 1.000000000 s: odometry: invalid pose: must be finite, with a unit quaternion");
  EXPECT_EQ(complaint_about("/tf", TransformSet{{placed("a", "b", unturned.T_odom_body)}}),
            "bad.mcap: /tf at 1.000000000 s: transform: invalid pose: must be finite, with a unit quaternion");
}

TEST_F(McapScans, AFileThatWasCutOffIsReadUpToTheCut) {
  for (int i = 0; i < 400; ++i) {
    writer.write("/odom", i * 50ms, odometry_at(i * 50ms));
    writer.write("/scan", i * 50ms, scan_at(i * 50ms, {1.0F + 0.01F * static_cast<float>(i), 2.0F}));
  }
  writer.close();
  const std::string bytes = read_bytes(file);
  write_bytes(file, bytes.substr(0, bytes.size() / 2));
  const Read result = read();
  EXPECT_GT(result.scans.size(), 50U);
  EXPECT_LT(result.scans.size(), 350U);
  EXPECT_EQ(result.summary.skipped.at("unexpected end of file"), 1U);
}

TEST_F(McapScans, ADamagedChunkIsRefusedOrLeftOut) {
  for (int i = 0; i < 400; ++i) {  // 20 s in chunks of one second
    writer.write("/odom", i * 50ms, odometry_at(i * 50ms));
    writer.write("/scan", i * 50ms, scan_at(i * 50ms, {1.0F + 0.01F * static_cast<float>(i), 2.0F}));
  }
  writer.close();
  std::string bytes = read_bytes(file);
  for (std::size_t i = bytes.size() / 3; i < bytes.size() / 3 + 20; ++i) bytes[i] = static_cast<char>(bytes[i] ^ 0x5a);
  write_bytes(file, bytes);
  EXPECT_THAT(complaint(), ::testing::MatchesRegex("log.mcap: byte [0-9]+: .*"));
  ScanLogOptions skip;
  skip.skip_invalid = true;
  const Read result = read(skip);
  EXPECT_THAT(result.scans.size(), ::testing::AllOf(::testing::Ge(360U), ::testing::Lt(400U)))
      << "no more than two chunks of 20 scans are lost";
  EXPECT_EQ(result.scans.back().scan.stamp, 399 * 50ms);
  EXPECT_GE(result.summary.skipped.at("damaged file sections"), 1U);
}

TEST_F(McapScans, DamageThatHidesTheNextRecordEndsTheFile) {
  for (int i = 0; i < 400; ++i) {
    writer.write("/odom", i * 50ms, odometry_at(i * 50ms));
    writer.write("/scan", i * 50ms, scan_at(i * 50ms));
  }
  writer.close();
  const std::string bytes = read_bytes(file);
  write_bytes(file, bytes.substr(0, bytes.size() / 2) + std::string(100'000, '\0') + bytes.substr(bytes.size() / 2));
  ScanLogOptions skip;
  skip.skip_invalid = true;
  const Read result = read(skip);
  EXPECT_GT(result.scans.size(), 100U);
  EXPECT_LT(result.scans.size(), 300U);
}

TEST_F(McapScans, AFileWithoutScansOrOdometryIsReported) {
  writer.write("/odom", 0s, odometry_at(0s));
  writer.close();
  EXPECT_EQ(complaint(), "log.mcap: contains no scan: must contain sensor_msgs/msg/LaserScan (1 read)");
  MessageFile other(file);
  for (int i = 0; i < 300; ++i) other.write("/scan", i * 100ms, scan_at(i * 100ms));
  other.close();
  EXPECT_EQ(complaint(),
            "log.mcap: no odometry overlaps the scans: must contain nav_msgs/msg/Odometry or tf odom -> base_link (300 "
            "read, 300 scans without odometry)");
}

TEST_F(McapScans, ARecordLargerThanAQuarterOfAGigabyteIsDamageNotData) {
  writer.close();
  std::string bytes(mcap::kMagic);
  mcap::RecordWriter head;
  head.record_head(mcap::kMessage, 9'000'000'000);
  write_bytes(file, bytes + std::string(head.view()));
  std::filesystem::resize_file(file, 10'000'000'000);  // sparse
  EXPECT_EQ(complaint(), "log.mcap: byte 8: a record of 9000000000 bytes is too large");
}

}  // namespace
}  // namespace patrol::io::mcap_scan_log_test
