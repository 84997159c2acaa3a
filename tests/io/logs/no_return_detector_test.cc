#include "io/logs/no_return_detector.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "io/logs/scan_log.h"
#include "tests/support/temporary_file.h"

namespace patrol::io::no_return_test {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

RecordedScan scan_at(double x_m, std::vector<float> ranges_m) {
  return {
      .scan = {.ranges_m = std::move(ranges_m), .intensities = {}}, .T_odom_body = {x_m, 0.0, 0.0}, .T_body_lidar = {}};
}

/// A corridor of 2 m, its end 27.9 m ahead of place 0, in which the robot sways by 15 cm; in centimeters as a SICK has
/// it, and what is farther than 8 m is none.
std::vector<float> corridor_cm(double x_m, float no_return_m) {
  std::vector<float> ranges_m;
  const double y_m = 0.15 * std::sin(x_m);
  for (int beam = 0; beam < 180; ++beam) {
    const double angle = to_rad(beam - 90);
    const double side_m = (1.0 + (beam > 90 ? y_m : -y_m)) / std::max(1e-9, std::abs(std::sin(angle))),
                 end_m = (27.9 - x_m) / std::max(1e-9, std::cos(angle));
    const double range_m = std::min(side_m, end_m);
    ranges_m.push_back(range_m < 8.0 ? static_cast<float>(std::round(range_m * 100.0) / 100.0) : no_return_m);
  }
  return ranges_m;
}

TEST(NoReturn, EightMetersReturnedAtFortyPositionsAreNone) {
  NoReturnDetector finder;
  for (int place = 0; place < 40; ++place) finder.add(scan_at(0.3 * place, corridor_cm(0.3 * place, 8.0F)));
  const auto found = finder.find();
  ASSERT_TRUE(found);
  EXPECT_EQ(found->range_m, 8.0F);
  EXPECT_EQ(found->num_positions, 40U);
  EXPECT_GE(found->num_readings, 40U * 13U) << "within 7 degrees of straight ahead";
}

TEST(NoReturn, OfSeveralCodesTheLowestIsFound) {
  NoReturnDetector finder;
  for (int place = 0; place < 40; ++place)
    finder.add(scan_at(0.3 * place, corridor_cm(0.3 * place, place % 2 == 0 ? 8.191F : 8.183F)));
  ASSERT_TRUE(finder.find());
  EXPECT_FLOAT_EQ(static_cast<float>(finder.find()->range_m), 8.183F);
}

TEST(NoReturn, ALidarWithoutANoReturnValueHasNone) {
  NoReturnDetector finder;
  for (int place = 0; place < 90; ++place) finder.add(scan_at(0.3 * place, corridor_cm(0.3 * place, kInfinity)));
  EXPECT_FALSE(finder.find());
}

// Without noise the end of the corridor is the same to the bit in every scan.
TEST(NoReturn, RestInFrontOfAWallIsNotConclusive) {
  NoReturnDetector finder;
  for (int scan = 0; scan < 1000; ++scan) finder.add(scan_at(0.0, std::vector<float>(20, 5.0F)));
  EXPECT_FALSE(finder.find());
  for (int place = 0; place < 9; ++place) finder.add(scan_at(1.0 + place, std::vector<float>(20, 5.0F)));
  EXPECT_TRUE(finder.find()) << "ten places";
}

TEST(NoReturn, AWallAlongThePathIsNoneAsNeighboringValuesAreAsFrequent) {
  NoReturnDetector finder;
  for (int place = 0; place < 100; ++place) {
    std::vector<float> ranges_m;
    for (int beam = 0; beam < 40; ++beam)
      ranges_m.push_back(std::round(500.0F / std::cos(0.01F * static_cast<float>(beam))) /
                         100.0F);  // 5.00, 5.00, 5.00, 5.01 ...
    finder.add(scan_at(0.3 * place, ranges_m));
  }
  EXPECT_FALSE(finder.find());
}

TEST(NoReturn, ALogWithEightMetersForNoReturnIsReadAsSuchUnlessDisabled) {
  std::string text;
  for (int place = 0; place < 40; ++place) {
    text += "FLASER 180";
    for (const float range_m : corridor_cm(0.3 * place, 8.0F)) text += fmt::format(" {:.2f}", range_m);
    text += fmt::format(" {0:.2f} 0 0 {0:.2f} 0 0 {1}.5 host 0.5\n", 0.3 * place, place);
  }
  const test::TemporaryFile file("a.log", text);
  const std::unique_ptr<ScanLog> log = open_scan_log(file.path());
  EXPECT_EQ(log->next()->scan.ranges_m[90], kInfinity);
  ASSERT_EQ(log->summary().found.size(), 1U);
  EXPECT_TRUE(log->summary().found[0].starts_with("8 m encodes no return: ")) << log->summary().found[0];
  ScanLogOptions as_it_is;
  as_it_is.detect_no_return = false;
  const std::unique_ptr<ScanLog> plain = open_scan_log(file.path(), as_it_is);
  EXPECT_EQ(plain->next()->scan.ranges_m[90], 8.0F);
  EXPECT_TRUE(plain->summary().found.empty());
}

}  // namespace
}  // namespace patrol::io::no_return_test
