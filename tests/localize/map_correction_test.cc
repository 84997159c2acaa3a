#include "localize/map_correction.h"

#include <gtest/gtest.h>

#include "tests/support/pose_near.h"

namespace patrol::localize::map_correction_test {
namespace {

using test::Pose2Near;

TEST(MapCorrection, IsThatOfTheLastScanNotAfterTheStamp) {
  const MapCorrection correction{.stamps = {from_seconds(1.0), from_seconds(2.0), from_seconds(3.0)},
                                 .T_map_old = {{0.1, 0.0, 0.0}, {0.2, 0.0, 0.0}, {0.3, 0.0, 0.0}}};
  const auto x_at = [&](double time_s) { return correction.at(from_seconds(time_s)).x; };
  EXPECT_EQ(x_at(0.5), 0.1);  // before the first scan
  EXPECT_EQ(x_at(1.0), 0.1);
  EXPECT_EQ(x_at(2.9), 0.2);
  EXPECT_EQ(x_at(9.0), 0.3);
}

TEST(MapCorrection, WithoutScansNothingMoves) {
  EXPECT_THAT(MapCorrection{}.at(from_seconds(1.0)), Pose2Near(Pose2{}, 0.0, 0.0));
}

}  // namespace
}  // namespace patrol::localize::map_correction_test
