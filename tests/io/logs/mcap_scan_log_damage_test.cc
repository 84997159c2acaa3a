#include "io/logs/mcap_scan_log.h"
#include "tests/io/logs/mcap_scans.h"

namespace patrol::io::mcap_scan_log_test {
namespace {

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
  EXPECT_THAT(complaint(),
              HasSubstr("log.mcap: /scan at 1.000000000 s: not a sensor_msgs/msg/LaserScan: the message is cut off"));
  const Read result = read(skip);
  EXPECT_EQ(result.scans.size(), 1U);
  EXPECT_THAT(result.summary.skipped, ElementsAre(Pair("unreadable messages", 1U)));
}

/// Bytes of a log with one message in JSON.
std::string json_log(const std::string& type, const std::string& topic) {
  const auto record = [](mcap::Opcode opcode, const auto& fill) {
    mcap::RecordWriter content, whole;
    fill(content);
    whole.record(opcode, content);
    return std::string(whole.view());
  };
  std::string bytes(mcap::kMagic);
  bytes += record(mcap::kSchema, [&](mcap::RecordWriter& schema) {
    schema.number(std::uint16_t{1});
    for (const std::string& text : {type, std::string("jsonschema"), std::string("{}")}) schema.text(text);
  });
  bytes += record(mcap::kChannel, [&](mcap::RecordWriter& channel) {
    for (int i = 0; i < 2; ++i) channel.number(std::uint16_t{1});
    for (const std::string& text : {topic, std::string("json")}) channel.text(text);
    channel.number(std::uint32_t{0});
  });
  bytes += record(mcap::kMessage, [](mcap::RecordWriter& message) {
    message.number(std::uint16_t{1});
    message.number(std::uint32_t{0});
    for (int i = 0; i < 2; ++i) message.number(std::uint64_t{1'000'000'000});
    message.raw("{}");
  });
  return bytes;
}

TEST_F(McapScans, AMessageInJsonIsRefusedByItsEncoding) {
  writer.close();
  write_bytes(file, json_log(kRosType<TransformSet>, "/tf"));
  EXPECT_EQ(complaint(), "log.mcap: /tf at 1.000000000 s: message encoding is json: must be cdr");
}

TEST_F(McapScans, ALogWhoseScansAreInJsonIsRefusedByTheEncoding) {
  writer.close();
  write_bytes(file, json_log("sensor_msgs/LaserScan", "/scan"));
  ScanLogOptions skip;
  skip.skip_invalid = true;
  EXPECT_EQ(
      complaint(skip),
      "log.mcap: contains no scan: must contain sensor_msgs/msg/LaserScan in CDR, the encoding of ROS 2 (1 read, 1 "
      "/scan, 1 unexpected end of file); other encodings in the log: json");
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
            "log.mcap: no odometry overlaps the scans: must contain nav_msgs/msg/Odometry or tf odom -> base_link or "
            "base_footprint, which may have a common namespace (300 read, 300 scans without odometry)");
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
