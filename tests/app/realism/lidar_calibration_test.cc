#include "app/realism/lidar_calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace patrol::app::lidar_calibration_test {
namespace {

TEST(MisfitWarning, IsThatOfADistanceAboveHalfOfThePresetsAndAboveThreePercent) {
  EXPECT_THAT(misfit_warning(0.062, 0.054), ::testing::HasSubstr("do not explain the log"));
  EXPECT_THAT(misfit_warning(0.062, 0.054), ::testing::HasSubstr("0.054, that of the preset 0.062"));
  EXPECT_EQ(misfit_warning(0.132, 0.049), "");
  EXPECT_EQ(misfit_warning(0.001, 0.002), "");
}

}  // namespace
}  // namespace patrol::app::lidar_calibration_test
