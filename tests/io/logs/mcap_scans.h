#pragma once

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "io/logs/mcap_scan_log.h"
#include "io/logs/run_log.h"
#include "tests/io/log_messages.h"
#include "tests/support/pose_near.h"
#include "tests/support/temporary_file.h"

namespace patrol::io::mcap_scan_log_test {

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

/// A robot stands for 3 s and then turns on the spot by 0.5 rad/s for 12 s, of which its odometry makes
/// `odometry_scale` times as much. Its gyro hangs upside down and has a bias of 0.03 rad/s about its own axis.
inline void turn_with_gyro(MessageFile& writer, double odometry_scale, bool has_place = true) {
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
inline ScanLogOptions with_imu(const std::string& imu) {
  ScanLogOptions options;
  options.imu = imu;
  options.detect_no_return = false;  // every scan of these files is the same
  return options;
}

}  // namespace patrol::io::mcap_scan_log_test
