#include "slam/calibration/calibration_contradiction.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/slam/calibration/calibration_world.h"

namespace patrol::slam::calibration_contradiction_test {
namespace {

using test::kWorn, test::record, test::wandering;
using ::testing::HasSubstr, ::testing::IsEmpty;

std::string contradiction_of(const std::vector<MotionSegment>& segments) {
  const CalibratorSettings settings;
  return calibration_contradiction(segments, calibrate(segments, {}, settings), settings.min_segments);
}

TEST(CalibrationContradiction, IsNoneOfAWornRobot) {
  EXPECT_THAT(contradiction_of(record(wandering(600), 6, kWorn, {}, 1)), IsEmpty());
}

TEST(CalibrationContradiction, OfBeamsInReversedOrderIsTheDirectionOfTheTurns) {
  std::vector<MotionSegment> segments = record(wandering(600), 6, kWorn, {}, 1);
  for (MotionSegment& segment : segments)
    for (Pose2& step : segment.lidar_steps) step = {step.x, -step.y, -step.yaw};
  EXPECT_THAT(contradiction_of(segments), HasSubstr("odometry and lidar turn in opposite directions in "));
}

TEST(CalibrationContradiction, OfAllSegmentsRejectedIsTheirNumber) {
  const std::vector<MotionSegment> segments = record(wandering(600), 6, kWorn, {}, 1);
  CalibrationResult result = calibrate(segments, {}, {});
  result.num_rejected = result.num_segments;
  EXPECT_THAT(calibration_contradiction(segments, result, 20),
              HasSubstr("100 of 100 segments rejected: odometry and lidar contradict each other"));
}

}  // namespace
}  // namespace patrol::slam::calibration_contradiction_test
