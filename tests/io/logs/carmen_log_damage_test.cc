#include <chrono>
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "io/logs/carmen_log.h"
#include "tests/io/logs/carmen_lines.h"
#include "tests/support/gzip_file.h"
#include "tests/support/temporary_file.h"

namespace patrol::io::carmen_log_damage_test {
namespace {

using namespace std::chrono_literals;
using carmen_lines::complaint_about, carmen_lines::flaser, carmen_lines::Read, carmen_lines::read,
    carmen_lines::repeated;
using test::gzipped, test::TemporaryFolder;
using ::testing::ElementsAre, ::testing::EndsWith, ::testing::Pair, ::testing::StartsWith;

const ScanLogOptions kSkip{.skip_invalid = true, .carmen_laser = {}, .scan_topic = {}, .odometry_topic = {}};

TEST(CarmenLog, AScanTooLateToPutInOrderIsRefusedOrSkipped) {
  std::string text;
  for (int i = 0; i < 40; ++i) text += flaser(std::to_string(100 + i));
  text += flaser("1");
  EXPECT_EQ(complaint_about(text),
            "a.log:41: FLASER: stamp 1.000000 s after 107.000000 s, more than 32 scans late: cannot be sorted");
  const Read result = read(text, kSkip);
  EXPECT_EQ(result.scans.size(), 40U);
  EXPECT_THAT(result.summary.skipped, ElementsAre(Pair("scans out of order", 1U)));
}

TEST(CarmenLog, UnreadableLinesAreNamed) {
  const std::string good = flaser("1");
  const auto complaint = [&](const std::string& bad) { return complaint_about(good + bad); };
  EXPECT_EQ(complaint("FLASER 4 1 2 3\n"), "a.log:2: FLASER: 3 words after the number of readings: must be 13");
  EXPECT_EQ(complaint(flaser("2", "1 2 0", "1 2 0", "5 1 2 3 4")),
            "a.log:2: FLASER: 13 words after the number of readings: must be 14");
  EXPECT_EQ(complaint(flaser("2", "1 2 0", "1 2 0", "3 1 2 3 4")),
            "a.log:2: FLASER: 13 words after the number of readings: must be 12");
  EXPECT_EQ(complaint(flaser("2", "1 2 0", "1 2 0", "4 1 2 x 4")), "a.log:2: FLASER: range 'x' is not a number");
  EXPECT_EQ(complaint(flaser("2", "1 2 nan", "1 2 0")), "a.log:2: FLASER: laser pose 'nan' is not a finite number");
  EXPECT_EQ(complaint(flaser("2", "1 2 0", "1 inf 0")), "a.log:2: FLASER: robot pose 'inf' is not a finite number");
  EXPECT_EQ(complaint(flaser("nan")), "a.log:2: FLASER: ipc_timestamp 'nan' is not a time in seconds");
  EXPECT_EQ(complaint("FLASER\n"), "a.log:2: FLASER: ends before num_readings");
  EXPECT_EQ(complaint("FLASER 0 1 2 0 1 2 0 1 h 1\n"),
            "a.log:2: FLASER: num_readings '0' must be an integer in [1, 10000]");
  EXPECT_EQ(complaint("FLASER 10001" + repeated("1", 10010) + "\n"),
            "a.log:2: FLASER: num_readings '10001' must be an integer in [1, 10000]");
  EXPECT_EQ(complaint("FLASER -3 1\n"), "a.log:2: FLASER: num_readings '-3' must be an integer in [1, 10000]");
  EXPECT_EQ(complaint("ODOM 1 2 nan 0 0 0 1 h 1\n"), "a.log:2: ODOM: robot pose 'nan' is not a finite number");
  EXPECT_EQ(complaint("ODOM 1 2\n"), "a.log:2: ODOM: 2 words after the name: must be 9");
  EXPECT_EQ(complaint("PARAM robot_frontlaser_offset far\n"),
            "a.log:2: PARAM: robot_frontlaser_offset 'far' is not a finite number");
  EXPECT_EQ(complaint("PARAM\n"), "a.log:2: PARAM: ends before parameter name");
  EXPECT_EQ(complaint(std::string("\x01\x00\xff garbage\n", 11)),
            "a.log:2: must begin with a message name such as FLASER or ODOM");
  EXPECT_EQ(complaint("1.07 1.08 1.09\n"), "a.log:2: must begin with a message name such as FLASER or ODOM");
  EXPECT_EQ(complaint("FLASER " + std::string(2'000'000, '1') + "\n"), "a.log:2: line longer than 1048576 bytes");
}

TEST(CarmenLog, UnreadableNewMessagesAreNamed) {
  const std::string laser = "ROBOTLASER1 0 -1 2 1 80 0 0 ";
  EXPECT_EQ(complaint_about(laser + "3 1 2 3 0 0 0 0 0 0 0 0 0 0 0 0 1 host\n"),
            "a.log:1: ROBOTLASER1: 13 words after the remissions: must be 14");
  EXPECT_EQ(complaint_about(laser + "300 1 2 3 0\n"), "a.log:1: ROBOTLASER1: 4 words left for 300 ranges: too few");
  EXPECT_EQ(complaint_about(laser + "3 1 2 3 9 1\n"), "a.log:1: ROBOTLASER1: 1 words left for 9 remissions: too few");
  EXPECT_EQ(complaint_about("ROBOTLASER1 0 -180 180 1 80 0 0 1 1 0\n"),
            "a.log:1: ROBOTLASER1: start_angle = -180 rad: exceeds one revolution");
  EXPECT_EQ(complaint_about("ROBOTLASER1 0 -1 nan 1 80 0 0 1 1 0\n"),
            "a.log:1: ROBOTLASER1: field_of_view 'nan' is not a finite number");
  EXPECT_EQ(complaint_about("RAWLASER1 0 -1 2 1 80 0 0 1 1 0 1 h\n"),
            "a.log:1: RAWLASER1: 2 words after the remissions: must be 3");
}

TEST(CarmenLog, WithSkipInvalidReadableLinesAreUsedAndOthersCounted) {
  const std::string zeros(3'000'000, '\0');
  const std::string text = flaser("1") + "FLASER 4 1 2\n" + flaser("2", "1 2 nan", "1 2 0") + zeros + "\n" +
                           flaser("3") + "FLASER 4 1 2 3 4 1";
  const Read result = read(text, kSkip);
  ASSERT_EQ(result.scans.size(), 2U);
  EXPECT_EQ(result.scans[1].scan.stamp, 3s);
  EXPECT_THAT(result.summary.skipped, ElementsAre(Pair("unreadable lines", 4U)));
  ASSERT_EQ(result.summary.warnings.size(), 4U);
  EXPECT_THAT(result.summary.warnings[2], EndsWith("a.log:4: line longer than 1048576 bytes"));
  EXPECT_THAT(to_text(result.summary), StartsWith("2 scans\nskipped: 4 unreadable lines\n  "));
}

TEST(CarmenLog, ACutOffGzipIsRefusedOrReadUpToTheCut) {
  std::string text;
  for (int i = 0; i < 2000; ++i) text += flaser(std::to_string(i), fmt::format("{} 2 0", i * 7919 % 10007), "1 2 0");
  const std::string bytes = gzipped(text);
  const std::string cut = bytes.substr(0, bytes.size() / 2);
  EXPECT_THAT(complaint_about(cut, kSkip), "");
  EXPECT_THAT(complaint_about(cut), ::testing::MatchesRegex("a.log: the gzip data are cut off after line [0-9]+"));
  const Read result = read(cut, kSkip);
  EXPECT_GT(result.scans.size(), 500U);
  EXPECT_EQ(result.summary.skipped.at("unexpected end of file"), 1U);
}

TEST(CarmenLog, AFileWithoutScansIsReportedWithItsContents) {
  EXPECT_EQ(complaint_about(""), "a.log: contains no scan (0 read): must contain FLASER, ROBOTLASER1 or RAWLASER1");
  EXPECT_EQ(complaint_about("SYNC a 1 h 1\nODOM 1 2 0 0 0 0 1 h 1\n"),
            "a.log: contains no scan (2 read, 1 ODOM, 1 SYNC): must contain FLASER, ROBOTLASER1 or RAWLASER1");
  EXPECT_EQ(complaint_about("RAWLASER1 0 0 3.14 1.57 80 0.01 0 3 1 2 3 0 1 h 1\n"),
            "a.log: contains RAWLASER1 without odometry (1 read, 1 scans before the first ODOM): must contain ODOM");
  EXPECT_EQ(complaint_about("FLASER 4 1\n", kSkip),
            "a.log: contains no scan (1 read, 1 unreadable lines): must contain FLASER, ROBOTLASER1 or RAWLASER1");
}

TEST(CarmenLog, TenGigabytesOfZeroBytesAreRefusedAtOnce) {
  const TemporaryFolder folder;
  test::write_bytes(folder / "a.log", "");
  std::filesystem::resize_file(folder / "a.log", 10'000'000'000);  // sparse
  try {
    open_scan_log(folder / "a.log")->next();
    FAIL() << "must throw";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), EndsWith("a.log:1: line longer than 1048576 bytes"));
  }
}

TEST(CarmenLog, TenGigabytesOfZeroBytesAfterALogAreGivenUpAfterSixtyFourMegabytes) {
  const TemporaryFolder folder;
  test::write_bytes(folder / "a.log", flaser("1") + flaser("2"));
  std::filesystem::resize_file(folder / "a.log", 10'000'000'000);  // sparse
  const std::unique_ptr<ScanLog> log = open_scan_log(folder / "a.log", kSkip);
  while (log->next()) {}
  EXPECT_EQ(log->summary().num_scans, 2U);
  EXPECT_THAT(log->summary().skipped, ElementsAre(Pair("unexpected end of file", 1U), Pair("unreadable lines", 1U)));
}

}  // namespace
}  // namespace patrol::io::carmen_log_damage_test
